#include "observe/mode_shape.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "observe/centre_line.hpp"

namespace ropewalk {
namespace {

using Complex = std::complex<double>;
using Eigen::Vector3cd;

constexpr double least_sideways = 0.01;  // part of the kinetic energy that makes a form

// The components of the deflections along their main direction, in which the sum of their squares is largest.
std::vector<double> in_main_plane(const std::vector<Vector3>& deflections) {
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const Vector3& d : deflections) spread += d * d.transpose();
  const Vector3 main = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvectors().col(2);
  std::vector<double> out;
  for (const Vector3& d : deflections) out.push_back(d.dot(main));
  return out;
}

// Changes of the sign of the curvature, and one. A twentieth of the largest curvature is none.
double half_waves_of(const std::vector<double>& y) {
  std::vector<double> curvature;
  double largest = 0;
  for (std::size_t k = 1; k + 1 < y.size(); ++k) {
    curvature.push_back(y[k - 1] - 2 * y[k] + y[k + 1]);
    largest = std::max(largest, std::fabs(curvature.back()));
  }
  if (!(largest > 0)) return 0;
  double changes = 0, last = 0;
  for (const double c : curvature) {
    if (std::fabs(c) < 0.05 * largest) continue;
    if (c * last < 0) ++changes;
    last = c;
  }
  return changes + 1;
}

}  // namespace

const char* ModeShape::name() const {
  const std::array<std::pair<double, const char*>, 7> all = {{{shares.sideways, "sideways"},
                                                              {shares.stretch, "stretch"},
                                                              {shares.turn, "twist"},
                                                              {shares.slip, "slip"},
                                                              {shares.section, "section"},
                                                              {shares.spin, "spin"},
                                                              {shares.tilt, "tilt"}}};
  return std::max_element(all.begin(), all.end())->second;
}

ModeShape shape_of(const Topology& topology, const State& state, const Eigen::VectorXd& mass, const Mode& mode) {
  ModeShape out;
  ModeShares& shares = out.shares;
  const int length = run_the_same_way(topology, state) ? common_length(topology) : 0;
  const CentreLine line = length > 0 ? centre_line(topology, state) : CentreLine{};
  const int sections = length > 0 ? length : topology.elements(), tubes = length > 0 ? topology.tubes() : 1;
  std::vector<Vector3> sideways;
  for (int k = 0; k < sections; ++k) {
    const auto element = [&](int t) { return length > 0 ? topology.tube_begin[t] + k : k; };
    const auto position = [&](int t) { return Vector3(state.position[static_cast<std::size_t>(element(t))]); };
    const auto axis = [&](int t) { return axis_of(state.orientation[static_cast<std::size_t>(element(t))]); };
    const auto moves = [&](int t) -> Vector3cd { return mode.shape.segment<3>(6 * element(t)); };
    const auto turns = [&](int t) -> Vector3cd { return mode.shape.segment<3>(6 * element(t) + 3); };
    const auto mass_of = [&](int t) { return mass[6 * element(t)]; };
    const Vector3 tangent = length > 0 ? line.tangents[static_cast<std::size_t>(k)] : axis(0);
    double whole = 0, arms = 0;
    Vector3 centre = Vector3::Zero();
    Vector3cd mean = Vector3cd::Zero();
    for (int t = 0; t < tubes; ++t) {
      whole += mass_of(t);
      centre += mass_of(t) * position(t);
      mean += mass_of(t) * moves(t);
    }
    centre /= whole;
    mean /= whole;
    Complex angle = 0;
    for (int t = 0; t < tubes; ++t) {
      const Vector3 arm = normal_part(position(t) - centre, tangent);
      angle += mass_of(t) * moves(t).dot(tangent.cross(arm).cast<Complex>());
      arms += mass_of(t) * arm.squaredNorm();
    }
    // Eigen conjugates the first factor of a product of vectors.
    angle = arms > 0 ? std::conj(angle) / arms : 0;
    const Complex along = tangent.cast<Complex>().dot(mean);
    const Vector3cd across = mean - along * tangent;
    shares.stretch += whole * std::norm(along);
    shares.sideways += whole * across.squaredNorm();
    shares.turn += arms * std::norm(angle);
    sideways.push_back(across.real());
    for (int t = 0; t < tubes; ++t) {
      const Vector3 arm = normal_part(position(t) - centre, tangent), own = axis(t);
      const Vector3cd left = moves(t) - mean - angle * tangent.cross(arm), turned = turns(t);
      const Complex slip = own.cast<Complex>().dot(left), spin = own.cast<Complex>().dot(turned);
      const double inertia = mass[6 * element(t) + 3];
      shares.slip += mass_of(t) * std::norm(slip);
      shares.section += mass_of(t) * (left - slip * own).squaredNorm();
      shares.spin += inertia * std::norm(spin);
      shares.tilt += inertia * (turned - spin * own).squaredNorm();
    }
  }
  const double sum =
      shares.sideways + shares.stretch + shares.turn + shares.slip + shares.section + shares.spin + shares.tilt;
  for (double* share :
       {&shares.sideways, &shares.stretch, &shares.turn, &shares.slip, &shares.section, &shares.spin, &shares.tilt})
    *share /= sum;
  out.windings = out.half_waves = std::numeric_limits<double>::quiet_NaN();
  if (length < 4 || !(shares.sideways > least_sideways)) return out;
  // A thousandth of the length at most, on the chord of the rope: a form of the mode, not of the rope.
  double most = 0;
  for (const Vector3& d : sideways) most = std::max(most, d.norm());
  const double span = (line.points.back() - line.points.front()).norm();
  const Vector3 chord = (line.points.back() - line.points.front()) / span;
  std::vector<Vector3> drawn;
  for (int k = 0; k < length; ++k)
    drawn.push_back(span * k / (length - 1.0) * chord +
                    1e-3 * span / most * normal_part(sideways[static_cast<std::size_t>(k)], chord));
  out.windings = helix_of(drawn).windings;
  out.half_waves = half_waves_of(in_main_plane(sideways));
  return out;
}

}  // namespace ropewalk
