// The stiffness of what acts between two elements and has a potential: minus the derivative of their forces and
// torques by their places and turns, by differences of the fourth order. Turns are those of
// sim/dynamics/tangent.hpp, and the part that half of the torques would make unsymmetric is left out.
//
// Units nm, eV, rad.
#pragma once

#include "sim/state/state.hpp"

namespace ropewalk {

struct Pose {
  Vector3 position;
  Quaternion orientation;
};
inline Pose pose_of(const State& s, int element) {
  const auto i = static_cast<std::size_t>(element);
  return {s.position[i], s.orientation[i]};
}

// Force and torque on the first element, then on the second one.
using PairVector = Eigen::Matrix<double, 12, 1>;
using PairMatrix = Eigen::Matrix<double, 12, 12>;

// f'(0) from f at four points `step` apart. The error goes as step^4 and as rounding over step.
template <class F>
auto derivative(const F& f, double step) {
  return ((8 * (f(step) - f(-step)) - (f(2 * step) - f(-2 * step))) / (12 * step)).eval();
}

// `forces`: of two poses, a PairVector. They must depend on the separation alone, not on where the pair is.
template <class Forces>
PairMatrix pair_stiffness(const Forces& forces, const Pose& i, const Pose& j) {
  constexpr double step = 1e-5;  // nm, rad
  const auto turned = [](const Pose& p, int axis, double by) {
    return Pose{p.position, Quaternion(Eigen::AngleAxisd(by, Vector3::Unit(axis))) * p.orientation};
  };
  PairMatrix k;
  for (int c = 0; c < 3; ++c) {
    k.col(6 + c) = -derivative(
        [&](double by) -> PairVector {
          return forces(i, Pose{j.position + by * Vector3::Unit(c), j.orientation});
        },
        step);
    k.col(c) = -k.col(6 + c);
    k.col(3 + c) = -derivative([&](double by) -> PairVector { return forces(turned(i, c, by), j); }, step);
    k.col(9 + c) = -derivative([&](double by) -> PairVector { return forces(i, turned(j, c, by)); }, step);
  }
  return 0.5 * (k + k.transpose());
}

}  // namespace ropewalk
