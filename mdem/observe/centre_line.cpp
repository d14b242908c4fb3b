#include "observe/centre_line.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "model/units.hpp"

namespace ropewalk {
namespace {

using Eigen::Vector2d;

constexpr double straight_fraction = 0.02;  // of the amplitude: points nearer to the chord count as straight

Vector3 unit_or_z(const Vector3& v) {
  const double norm = v.norm();
  return norm > 0.0 ? Vector3(v / norm) : Vector3::UnitZ();
}

std::vector<Vector3> differences(const std::vector<Vector3>& line) {
  std::vector<Vector3> tangents;
  const int n = static_cast<int>(line.size());
  for (int k = 0; k < n; ++k)
    tangents.push_back(unit_or_z(line[std::min(k + 1, n - 1)] - line[std::max(k - 1, 0)]));
  return tangents;
}

// Deviations from the chord, each as two coordinates normal to it. Empty where there is no chord.
std::vector<Vector2d> deviations(const std::vector<Vector3>& line) {
  std::vector<Vector2d> out;
  if (line.size() < 2) return out;
  const Vector3 chord = line.back() - line.front();
  if (chord.norm() <= 1e-9 * arc_length(line)) return out;
  const Vector3 z = chord.normalized();
  const Vector3 x = z.unitOrthogonal();
  const Vector3 y = z.cross(x);
  for (const Vector3& p : line) out.emplace_back((p - line.front()).dot(x), (p - line.front()).dot(y));
  return out;
}

double largest_norm(const std::vector<Vector2d>& v) {
  double largest = 0.0;
  for (const Vector2d& p : v) largest = std::max(largest, p.norm());
  return largest;
}

// Subtracts the least-squares line over the index.
std::vector<Vector2d> detrended(std::vector<Vector2d> v) {
  const double n = static_cast<double>(v.size());
  const double middle = 0.5 * (n - 1.0);
  Vector2d mean = Vector2d::Zero(), moment = Vector2d::Zero();
  for (std::size_t k = 0; k < v.size(); ++k) {
    mean += v[k] / n;
    moment += (static_cast<double>(k) - middle) * v[k];
  }
  const Vector2d slope = moment * (12.0 / (n * (n * n - 1.0)));
  for (std::size_t k = 0; k < v.size(); ++k) v[k] -= mean + slope * (static_cast<double>(k) - middle);
  return v;
}

// Mean azimuth per step, weighted with the square of the distance from the axis. The cross product is the squared
// distance times the sine of the azimuth step: it has no jump where the line passes its axis.
double azimuth_rate(const std::vector<Vector2d>& v) {
  double swept = 0.0, weight = 0.0;
  for (std::size_t k = 0; k + 1 < v.size(); ++k) {
    swept += v[k].x() * v[k + 1].y() - v[k].y() * v[k + 1].x();
    weight += 0.25 * (v[k] + v[k + 1]).squaredNorm();
  }
  return weight > 0.0 ? swept / weight : 0.0;
}

}  // namespace

int common_length(const Topology& topology) {
  if (topology.tubes() < 1) return 0;
  const int n = topology.length_of(0);
  for (int t = 1; t < topology.tubes(); ++t)
    if (topology.length_of(t) != n) return 0;
  return n;
}

bool run_the_same_way(const Topology& topology, const State& state) {
  std::vector<Vector3> ways;
  Vector3 sum = Vector3::Zero();
  for (int t = 0; t < topology.tubes(); ++t) {
    const auto first = static_cast<std::size_t>(topology.tube_begin[t]),
               last = static_cast<std::size_t>(topology.tube_begin[t + 1]) - 1;
    const Vector3 way =
        first == last ? axis_of(state.orientation[first]) : unit_or_z(state.position[last] - state.position[first]);
    ways.push_back(way);
    sum += way;
  }
  // If half of the tubes run against the other half, their mean is zero: the first tube then gives the direction.
  const double few = 1e-3 * static_cast<double>(ways.size());
  const Vector3 mean = sum.norm() > few ? Vector3(sum.normalized()) : ways.empty() ? sum : ways.front();
  return std::all_of(ways.begin(), ways.end(), [&](const Vector3& way) { return way.dot(mean) > -0.5; });
}

Vector3 tube_tangent(const Topology& topology, const State& state, int tube, int index) {
  const int first = topology.tube_begin[tube], n = topology.length_of(tube);
  if (n < 2) return axis_of(state.orientation[first + index]);
  const int before = std::max(index - 1, 0), after = std::min(index + 1, n - 1);
  return unit_or_z(state.position[first + after] - state.position[first + before]);
}

namespace {

// Centre line of the tubes from `from` up to that before `behind`.
CentreLine line_of(const Topology& topology, const State& state, int from, int behind) {
  const int n = common_length(topology), tubes = behind - from;
  CentreLine line;
  line.points.assign(n, Vector3::Zero());
  for (int t = from; t < behind && n > 0; ++t)
    for (int k = 0; k < n; ++k) line.points[k] += state.position[topology.tube_begin[t] + k] / tubes;
  line.tangents = differences(line.points);
  if (n == 1) {
    Vector3 sum = Vector3::Zero();
    for (int t = from; t < behind; ++t) sum += tube_tangent(topology, state, t, 0);
    line.tangents[0] = unit_or_z(sum);
  }
  return line;
}

}  // namespace

CentreLine centre_line(const Topology& topology, const State& state) {
  return line_of(topology, state, 0, topology.tubes());
}

std::vector<CentreLine> rope_lines(const Topology& topology, const State& state) {
  std::vector<CentreLine> lines;
  for (int rope = 0; rope < topology.ropes(); ++rope) {
    const auto [from, behind] = topology.strands_of_rope(rope);
    lines.push_back(line_of(topology, state, from, behind));
  }
  return lines;
}

double arc_length(const std::vector<Vector3>& line) {
  double length = 0.0;
  for (std::size_t k = 0; k + 1 < line.size(); ++k) length += (line[k + 1] - line[k]).norm();
  return length;
}

double chord_amplitude(const std::vector<Vector3>& line) {
  const std::vector<Vector2d> lateral = deviations(line);
  if (!lateral.empty()) return largest_norm(lateral);
  double largest = 0.0;
  for (const Vector3& p : line) largest = std::max(largest, (p - line.front()).norm());
  return largest;
}

std::vector<Vector3> middle_of(const std::vector<Vector3>& line) {
  const auto left_out = static_cast<std::ptrdiff_t>(line.size() / 10);
  return {line.begin() + left_out, line.end() - left_out};
}

namespace {

// The solid angle of the directions in which the pieces a to b and c to d cross, with the sign of their crossing; 0
// where they lie in a plane.
double crossing_angle(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d) {
  const std::array<Vector3, 4> sides{c - a, d - a, d - b, c - b};
  std::array<Vector3, 4> normals;
  for (std::size_t k = 0; k < 4; ++k) {
    const Vector3 normal = sides[k].cross(sides[(k + 1) % 4]);
    const double size = normal.norm();
    if (!(size > 0)) return 0;
    normals[k] = normal / size;
  }
  double angle = 0;
  for (std::size_t k = 0; k < 4; ++k)
    angle += std::asin(std::clamp(normals[k].dot(normals[(k + 1) % 4]), -1.0, 1.0));
  const double side = (d - c).cross(b - a).dot(sides[0]);
  return side > 0 ? angle : side < 0 ? -angle : 0;
}

}  // namespace

double writhe_of(const std::vector<Vector3>& line) {
  constexpr std::size_t most = 128;
  const std::size_t step = (line.size() + most - 1) / most;
  std::vector<Vector3> points;
  for (std::size_t k = 0; k < line.size(); k += step) points.push_back(line[k]);
  if (!line.empty() && (line.size() - 1) % step != 0) points.push_back(line.back());
  double sum = 0;
  for (std::size_t i = 0; i + 1 < points.size(); ++i)
    for (std::size_t j = i + 2; j + 1 < points.size(); ++j)
      sum += crossing_angle(points[i], points[i + 1], points[j], points[j + 1]);
  return sum / (2 * units::pi);
}

double turned_back(const std::vector<Vector3>& line) {
  if (line.size() < 2) return 0;
  const Vector3 chord = line.back() - line.front();
  double back = 0;
  for (std::size_t k = 0; k + 1 < line.size(); ++k) {
    const Vector3 piece = line[k + 1] - line[k];
    if (piece.dot(chord) < 0) back += piece.norm();
  }
  const double whole = arc_length(line);
  return whole > 0 ? back / whole : 0;
}

// Counting the azimuth from end to end fails on real ropes: a helix whose ends lie on its axis has no azimuth
// there, a chord that runs along the side of a helix (free ends) is no axis, and a plane bow or S has jumps of
// pi. So the turns are the mean azimuth rate, weighted with the square of the distance from the axis, times
// the length of the line that is not straight. The axis is the chord moved and tilted to the least-squares
// line: right for a helix of any number of turns with free ends. On ideal helices of 1.5 turns and more with
// constant, sine or plateau envelope this is within 0.15 turns; a plane curve has none. Below 1.5 turns helix
// and bow are not well apart (1 turn reads as 1.0 to 1.4).
LineHelix helix_of(const std::vector<Vector3>& line) {
  LineHelix out;
  const std::vector<Vector2d> lateral = deviations(line);
  if (lateral.size() < 3) return out;
  const double straight = straight_fraction * largest_norm(lateral);
  int bent_steps = 0;
  for (std::size_t k = 0; k + 1 < lateral.size(); ++k)
    bent_steps += 0.5 * (lateral[k] + lateral[k + 1]).norm() > straight;
  const std::vector<Vector2d> from_axis = detrended(lateral);
  const double turns_per_step = azimuth_rate(from_axis) / (2.0 * units::pi);
  double squares = 0, weight = 0;
  for (std::size_t k = 0; k < lateral.size(); ++k) {
    if (lateral[k].norm() <= straight) continue;
    squares += from_axis[k].squaredNorm();
    weight += 1;
  }
  out.windings = turns_per_step * bent_steps;
  if (weight > 0) out.radius = std::sqrt(squares / weight);
  if (std::fabs(out.windings) >= 0.5)
    out.pitch =
        (line.back() - line.front()).norm() / static_cast<double>(line.size() - 1) / std::fabs(turns_per_step);
  return out;
}

}  // namespace ropewalk
