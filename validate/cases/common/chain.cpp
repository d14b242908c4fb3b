#include "cases/common/chain.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <utility>

#include "cases/common/straight_tubes.hpp"
#include "model/error.hpp"

namespace ropewalk::validate {

Chain::Chain(const ParameterSet& set, int bonds) : last(bonds) {
  BuiltScene tube = straight_tubes(set, bonds + 1);
  topology = std::move(tube.topology);
  state = std::move(tube.state);
  for (int i = 0; i <= bonds; ++i) state.position.set(static_cast<std::size_t>(i), {0, 0, i * set.element_length});
}

Simulation Chain::make(double step_fraction) const {
  return Simulation(topology, interaction, loads, state,
                    step_fraction * time_step_limit(topology, interaction, 0).limit);
}

Simulation Chain::relaxed(double tolerance) const { return at_rest(make(), tolerance, 400000); }

Simulation at_rest(Simulation simulation, double tolerance, long max_steps) {
  if (!simulation.relax(tolerance, max_steps, [](long) { return true; }))
    throw NumericalError(simulation.state().step, -1, "the relaxation did not come to rest",
                         "allow more steps or a larger force");
  return simulation;
}

Quaternion turn_about(const Vector3& axis, double angle) { return Quaternion(Eigen::AngleAxisd(angle, axis)); }

Quaternion small_turn(const Vector3& angles) {
  const double angle = angles.norm();
  return angle > 0 ? turn_about(angles / angle, angle) : Quaternion::Identity();
}

Eigen::VectorXd chain_forces(const BondStiffness& bond, double element_length, const State& state) {
  Eigen::VectorXd out = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(6 * state.size()));
  for (std::size_t i = 0; i + 1 < state.size(); ++i) {
    const BondForce f =
        bond_energy_and_gradient(bond, element_length, state.position[i + 1] - state.position[i],
                                 frame_of(state.orientation[i]), frame_of(state.orientation[i + 1]));
    const auto at = static_cast<Eigen::Index>(6 * i);
    out.segment<3>(at) -= f.force_j;
    out.segment<3>(at + 3) += f.torque_i;
    out.segment<3>(at + 6) += f.force_j;
    out.segment<3>(at + 9) += f.torque_j;
  }
  return out;
}

namespace {

void displace(State& state, int freedom, double by) {
  const auto element = static_cast<std::size_t>(freedom / 6);
  const Vector3 along = Vector3::Unit(freedom % 3);
  if (freedom % 6 < 3)
    state.position.add(element, by * along);
  else
    state.orientation.set(element, turn_about(along, by) * state.orientation[element]);
}

}  // namespace

Eigen::MatrixXd tangent_stiffness(const BondStiffness& bond, double element_length, const State& state,
                                  const std::vector<int>& freedoms) {
  constexpr double h = 1e-5;
  const auto n = static_cast<Eigen::Index>(freedoms.size());
  Eigen::MatrixXd stiffness(n, n);
  for (Eigen::Index j = 0; j < n; ++j) {
    const int freedom = freedoms[static_cast<std::size_t>(j)];
    State plus = state, minus = state;
    displace(plus, freedom, h);
    displace(minus, freedom, -h);
    const Eigen::VectorXd d = chain_forces(bond, element_length, minus) - chain_forces(bond, element_length, plus);
    for (Eigen::Index i = 0; i < n; ++i) stiffness(i, j) = d(freedoms[static_cast<std::size_t>(i)]) / (2 * h);
  }
  return stiffness;
}

double lowest_eigenvalue(const Eigen::MatrixXd& stiffness) {
  return Eigen::EigenSolver<Eigen::MatrixXd>(stiffness, false).eigenvalues().real().minCoeff();
}

double zero_between(const std::function<double(double)>& falling, double low, double high) {
  for (int k = 0; k < 14; ++k) {
    const double middle = 0.5 * (low + high);
    (falling(middle) > 0 ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

namespace {

// Lowest eigenvalue of a straight chain, shortened by the load, whose ends stay on the axis and turn freely.
// Motions in one plane suffice.
double lowest_under_load(const ParameterSet& set, int bonds, double load) {
  Chain c(set, bonds);
  const double shortened = set.element_length * (1 - load / set.bond.stretch);
  std::vector<int> freedoms;
  for (int i = 0; i <= bonds; ++i) {
    c.state.position.set(static_cast<std::size_t>(i), {0, 0, i * shortened});
    if (i > 0 && i < bonds) freedoms.push_back(6 * i);
    freedoms.push_back(6 * i + 4);
  }
  return lowest_eigenvalue(tangent_stiffness(set.bond, set.element_length, c.state, freedoms));
}

}  // namespace

void refuse_slip(const ParameterSet& set, double moment) {
  if (moment * set.element_length < 0.9 * set.bond.twist) return;
  throw NotApplicable(fmt::format("GJ is {:.2g} of EI: a bond of {:.3g} nm slips in twist before the chain buckles",
                                  set.bond.twist / set.bond.bend, set.element_length));
}

double buckling_load(const ParameterSet& set, int bonds, double expected) {
  return zero_between([&](double p) { return lowest_under_load(set, bonds, p); }, 0.5 * expected, 2.5 * expected);
}

}  // namespace ropewalk::validate
