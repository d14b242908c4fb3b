#include "observe/observe.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "observe/centre_line.hpp"

namespace ropewalk {
namespace {

constexpr double on_axis = 0.25;  // of the spacing: the azimuth of a tube nearer to the centre line is not used

double angle_between(const Vector3& a, const Vector3& b) { return std::atan2(a.cross(b).norm(), a.dot(b)); }

// The frames of a bond, which twist and bend are read from: against its natural shape.
BondEnds ends_of_bond(const TubeType& type, const State& state, int i) {
  return bond_ends(type.bond, type.element_length, frame_of(state.orientation[i]), frame_of(state.orientation[i + 1]));
}

bool beyond(double value, double limit) { return limit > 0.0 && value > limit; }

void count_bond(const TubeType& type, const State& state, const Validity& validity, int i, const BondEnds& ends,
                double twist, RopeObservation& out) {
  const double a = type.element_length;
  out.largest_bond_twist = std::max(out.largest_bond_twist, std::abs(twist));
  if (a <= 0.0) return;
  const double bend = angle_between(ends.i.t, ends.j.t);
  const double strain = (state.position[i + 1] - state.position[i]).norm() / a - 1.0;
  out.kinked += beyond(bend / a, validity.kink_curvature);
  out.overtwisted += beyond(type.radius * std::abs(twist) / a, validity.twist_collapse);
  out.overstretched += beyond(strain, validity.largest_tension()) + beyond(-strain, validity.stretch);
}

// The quantities of single tubes.
void observe_bonds(const Topology& topology, const State& state, const std::vector<Validity>& validity,
                   RopeObservation& out) {
  double sum = 0.0;
  for (int t = 0; t < topology.tubes(); ++t)
    for (int i = topology.tube_begin[t]; i + 1 < topology.tube_begin[t + 1]; ++i) {
      if (has_parted(topology.type_of(t), state.position[i + 1] - state.position[i])) continue;
      const BondEnds ends = ends_of_bond(topology.type_of(t), state, i);
      const double twist = bond_twist_angle(ends.i, ends.j);
      sum += twist;
      count_bond(topology.type_of(t), state, validity[static_cast<std::size_t>(topology.tube_type[t])], i, ends, twist,
                 out);
    }
  if (topology.tubes() > 0) out.physical_twist = sum / topology.strands();
}

// Mean angle of the outermost tubes to the local axis of their rope in the middle third.
double twist_angle(const Topology& topology, const State& state, const RopeShells& shells,
                   const std::vector<CentreLine>& lines) {
  double sum = 0.0;
  int count = 0;
  for (int rope = 0; rope < topology.ropes(); ++rope) {
    const CentreLine& line = lines[static_cast<std::size_t>(rope)];
    const int n = static_cast<int>(line.points.size());
    const auto [from, behind] = topology.strands_of_rope(rope);
    for (int t = from; t < std::min(behind, static_cast<int>(shells.outermost.size())); ++t) {
      if (!shells.outermost[t]) continue;
      for (int k = n / 3; k < n - n / 3; ++k, ++count)
        sum += angle_between(tube_tangent(topology, state, t, k), line.tangents[k]);
    }
  }
  return count > 0 ? sum / count : 0.0;
}

// The rotations that carry a direction along the centre line without turning it about the line (a discrete Bishop
// frame). The rotation of a tube against this frame is twist; the writhe of the line does not enter.
std::vector<Quaternion> transports(const CentreLine& line) {
  std::vector<Quaternion> steps;
  for (std::size_t k = 0; k + 1 < line.tangents.size(); ++k)
    steps.push_back(Quaternion::FromTwoVectors(line.tangents[k], line.tangents[k + 1]));
  return steps;
}

// The angle of a helix is that of its turn times its radius to its advance along the axis. Mean over the ropes and
// the middle third; weighted with the advance, so that no single short step counts.
double ply_angle(const std::vector<CentreLine>& ropes, const CentreLine& whole,
                 const std::vector<Quaternion>& steps) {
  if (ropes.size() < 2) return std::numeric_limits<double>::quiet_NaN();
  const std::size_t n = whole.points.size(), from = n / 3, to = n - n / 3;
  double round = 0, along = 0;
  for (const CentreLine& rope : ropes)
    for (std::size_t k = from; k + 1 < to; ++k) {
      const Vector3 here = normal_part(rope.points[k] - whole.points[k], whole.tangents[k]),
                    next = normal_part(rope.points[k + 1] - whole.points[k + 1], whole.tangents[k + 1]),
                    carried = steps[k] * here;
      const double turn = std::atan2(whole.tangents[k + 1].dot(carried.cross(next)), carried.dot(next));
      round += 0.5 * (here.norm() + next.norm()) * turn;
      along += (whole.points[k + 1] - whole.points[k]).norm();
    }
  return along > 0 ? std::atan2(round, along) : std::numeric_limits<double>::quiet_NaN();
}

struct Turning {
  double angle = 0;    // rad, end to end, right-handed positive
  double nearest = 0;  // nm, smallest distance from the centre line
};

Turning turning_of(const Topology& topology, const State& state, const CentreLine& line,
                   const std::vector<Quaternion>& steps, int tube) {
  const int first = topology.tube_begin[tube];
  const auto arm = [&](int k) { return normal_part(state.position[first + k] - line.points[k], line.tangents[k]); };
  Vector3 last = arm(0);
  Turning turning{0.0, last.norm()};
  for (std::size_t k = 0; k < steps.size(); ++k) {
    const Vector3 carried = steps[k] * last;
    last = arm(static_cast<int>(k) + 1);
    turning.angle += std::atan2(line.tangents[k + 1].dot(carried.cross(last)), carried.dot(last));
    turning.nearest = std::min(turning.nearest, last.norm());
  }
  return turning;
}

double geometric_twist(const Topology& topology, const State& state, const CentreLine& line,
                       const std::vector<Quaternion>& steps, double scale) {
  double sum = 0.0;
  int count = 0;
  for (int t = 0; t < topology.tubes(); ++t) {
    const Turning turning = turning_of(topology, state, line, steps, t);
    if (turning.nearest <= on_axis * scale) continue;
    sum += turning.angle;
    ++count;
  }
  return count > 0 ? sum / count : 0.0;
}

std::vector<double> outer_radii(const Topology& topology, const State& state, const CentreLine& line) {
  std::vector<double> radii;
  for (std::size_t k = 0; k < line.points.size(); ++k) {
    double largest = 0.0;
    for (int t = 0; t < topology.tubes(); ++t) {
      const Vector3 arm = state.position[topology.tube_begin[t] + k] - line.points[k];
      largest = std::max(largest, normal_part(arm, line.tangents[k]).norm());
    }
    radii.push_back(largest + topology.largest_radius());
  }
  return radii;
}

}  // namespace

RopeObservation observe(const Topology& tubes, const State& state, const RopeShells& shells,
                        const std::vector<Validity>& validity, double neighbour_radius, double spacing) {
  RopeObservation out;
  observe_bonds(tubes, state, validity, out);
  const Topology topology = strands_of(tubes);
  const int n = common_length(topology);
  if (topology.tubes() > 0 && (n == 0 || !run_the_same_way(topology, state))) {
    for (double* none : {&out.beta, &out.geometric_twist, &out.ply_angle, &out.radius_mid, &out.radius_end,
                         &out.length, &out.amplitude, &out.middle_amplitude, &out.writhe, &out.turned_back,
                         &out.windings, &out.middle.void_area})
      *none = std::numeric_limits<double>::quiet_NaN();
    return out;
  }
  if (n == 0) return out;
  const double scale = spacing > 0.0 ? spacing : 2.0 * topology.largest_radius();  // a lone tube has no spacing
  const CentreLine line = centre_line(topology, state);
  const std::vector<CentreLine> ropes = rope_lines(topology, state);
  const std::vector<Quaternion> steps = transports(line);
  out.beta = twist_angle(topology, state, shells, ropes);
  out.geometric_twist = geometric_twist(topology, state, line, steps, scale);
  out.ply_angle = ply_angle(ropes, line, steps);
  out.radius_profile = outer_radii(topology, state, line);
  out.radius_mid = out.radius_profile[n / 2];
  out.radius_end = 0.5 * (out.radius_profile.front() + out.radius_profile.back());
  out.length = arc_length(line.points);
  out.amplitude = chord_amplitude(line.points);
  out.middle_amplitude = chord_amplitude(middle_of(line.points));
  out.writhe = writhe_of(line.points);
  out.turned_back = turned_back(line.points);
  if (out.amplitude > scale) {
    const LineHelix helix = helix_of(line.points);
    out.windings = helix.windings;
    out.helix_radius = helix.radius;
    out.pitch = helix.pitch;
  }
  out.centre_line = line.points;
  out.middle = cross_section(tubes, state, shells, n / 2, neighbour_radius, spacing);
  return out;
}

}  // namespace ropewalk
