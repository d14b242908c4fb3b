#include "cases/common/parallel_bond.hpp"

#include <vector>

#include "cases/common/chain.hpp"
#include "cases/common/straight_tubes.hpp"

namespace ropewalk::validate {

// Shear and bending stiffness are chosen such that a chain is a slender beam, as in the total-energy bond.
ParallelBond::ParallelBond(const BondStiffness& bond, double a)
    : normal_(bond.stretch / a),
      shear_(12 * bond.bend / (a * a * a)),
      bend_(bond.bend / a),
      twist_(bond.twist / a) {}

void ParallelBond::advance(const Vector3& before, const Vector3& after, const ElementMove& i,
                           const ElementMove& j) {
  const Vector3 n = after.normalized();
  // The accumulated force and moment turn with the bond's direction and with the mean spin about it.
  const Quaternion follow =
      turn_about(n, 0.5 * (i.turn + j.turn).dot(n)) * Quaternion::FromTwoVectors(before, after);
  force_ = follow * force_;
  moment_ = follow * moment_;
  const Vector3 slip = j.shift - i.shift - (i.turn + j.turn).cross(0.25 * (before + after));
  const Vector3 turn = j.turn - i.turn;
  const Vector3 along = slip.dot(n) * n, spin = turn.dot(n) * n;
  force_ -= normal_ * along + shear_ * (slip - along);
  moment_ -= twist_ * spin + bend_ * (turn - spin);
}

double ParallelBond::energy(const Vector3& separation) const {
  const Vector3 n = separation.normalized();
  const double fn = force_.dot(n), mn = moment_.dot(n);
  return 0.5 * (fn * fn / normal_ + (force_.squaredNorm() - fn * fn) / shear_ + mn * mn / twist_ +
                (moment_.squaredNorm() - mn * mn) / bend_);
}

double parallel_bond_deflection(const ParameterSet& set, int bonds, double force) {
  const TubeType type = straight_tubes(set, 1).topology.types[0];
  const auto n = static_cast<std::size_t>(bonds) + 1;
  const double length = bonds * type.element_length;
  // Aperiodic for the slowest mode, 3.516 sqrt(EI/mu)/L^2.
  const double slowest = 3.516 * std::sqrt(set.bond.bend * type.element_length / type.mass) / (length * length);
  const double dt = 0.3 * 2 / stiffest_chain_frequency(type.bond, type.element_length, type.mass, type.inertia);
  const double brake = 1 - 2 * slowest * dt;
  std::vector<Vector3> x(n), v(n, Vector3::Zero()), w(n, Vector3::Zero()), f(n), t(n);
  std::vector<ParallelBond> bond(n - 1, ParallelBond(set.bond, type.element_length));
  for (std::size_t k = 0; k < n; ++k) x[k] = {0, 0, static_cast<double>(k) * type.element_length};
  const std::vector<Vector3> start = x;
  const auto steps = static_cast<long>(30 / (slowest * dt));
  for (long step = 0; step < steps; ++step) {
    std::fill(f.begin(), f.end(), Vector3::Zero());
    std::fill(t.begin(), t.end(), Vector3::Zero());
    f.back() = {force, 0, 0};
    for (std::size_t k = 0; k + 1 < n; ++k) {
      const Vector3 lever = -0.5 * (x[k + 1] - x[k]).cross(bond[k].force());
      f[k] -= bond[k].force();
      f[k + 1] += bond[k].force();
      t[k] += lever - bond[k].moment();
      t[k + 1] += lever + bond[k].moment();
    }
    const std::vector<Vector3> before = x;
    for (std::size_t k = 1; k < n; ++k) {
      v[k] = brake * v[k] + dt / type.mass * f[k];
      w[k] = brake * w[k] + dt / type.inertia * t[k];
      x[k] += dt * v[k];
    }
    for (std::size_t k = 0; k + 1 < n; ++k)
      bond[k].advance(before[k + 1] - before[k], x[k + 1] - x[k], {dt * v[k], dt * w[k]},
                      {dt * v[k + 1], dt * w[k + 1]});
  }
  return x.back().x() - start.back().x();
}

}  // namespace ropewalk::validate
