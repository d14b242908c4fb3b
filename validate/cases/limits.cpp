#include "cases/limits.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>

#include "model/error.hpp"
#include "scene/random.hpp"
#include "sim/forces.hpp"

namespace ropewalk {
namespace {

constexpr double enough_growth = 1e6;  // of the kinetic energy

}  // namespace

double limit_between(const std::function<bool(double)>& fails, double low, double high, double relative) {
  if (fails(low) || !fails(high)) return std::numeric_limits<double>::quiet_NaN();
  while (high - low > relative * high) {
    const double middle = 0.5 * (low + high);
    (fails(middle) ? high : low) = middle;
  }
  return 0.5 * (low + high);
}

double growth(const Topology& topology, const Interaction& interaction, const State& state, double time_step,
              long steps) {
  State shaken = state;
  Random random(3);
  for (std::size_t i = 0; i < shaken.size(); ++i) {
    const auto any = [&] { return Vector3(random.normal(), random.normal(), random.normal()); };
    shaken.velocity.add(i, 1e-6 * any());
    shaken.angular_velocity.add(i, 1e-6 * any());
  }
  const double before = kinetic_energy(topology, shaken);
  double factor = 1;
  try {
    Simulation s(topology, interaction, {}, shaken, time_step);
    for (long k = 0; k < steps && factor < enough_growth; ++k) {
      s.step();
      factor = kinetic_energy(topology, s.state()) / before;
    }
  } catch (const NumericalError&) {
    factor = std::numeric_limits<double>::infinity();
  }
  return factor;
}

ParameterSet with_elements(ParameterSet set, double factor) {
  set.element_length *= factor;
  return set;
}

bool blows_up(const Topology& topology, const Interaction& interaction, const State& state, double time_step,
              long steps) {
  return !(growth(topology, interaction, state, time_step, steps) < enough_growth);
}

double stiffest_frequency(const Topology& topology, const Interaction& interaction, const State& state) {
  const auto n = static_cast<Eigen::Index>(6 * state.size());
  constexpr double h = 1e-5;  // nm, rad
  NeighbourList list(interaction, 0.2);
  list.build(topology, state);
  ForceEngine engine;
  const auto forces = [&](Eigen::Index freedom, double by) {
    State moved = state;
    const auto i = static_cast<std::size_t>(freedom / 6);
    const Vector3 along = by * Vector3::Unit(freedom % 3);
    if (freedom % 6 < 3) {
      moved.position.add(i, along);
    } else {
      moved.orientation.set(i, small_turn(along) * moved.orientation[i]);
    }
    Forces f(moved.size());
    engine.compute(topology, interaction, list, moved, f);
    Eigen::VectorXd out(n);
    for (std::size_t e = 0; e < moved.size(); ++e) {
      out.segment<3>(static_cast<Eigen::Index>(6 * e)) = f.force[e];
      out.segment<3>(static_cast<Eigen::Index>(6 * e + 3)) = f.torque[e];
    }
    return out;
  };
  Eigen::VectorXd root(n);  // of mass and inertia
  for (Eigen::Index k = 0; k < n; ++k) {
    const TubeType& type = topology.type_of_element(static_cast<int>(k / 6));
    root[k] = std::sqrt(k % 6 < 3 ? type.mass : type.inertia);
  }
  Eigen::MatrixXd stiffness(n, n);
  for (Eigen::Index k = 0; k < n; ++k) stiffness.col(k) = (forces(k, -h) - forces(k, h)) / (2 * h);
  stiffness = root.cwiseInverse().asDiagonal() * stiffness * root.cwiseInverse().asDiagonal();
  const Eigen::MatrixXd symmetric = 0.5 * (stiffness + stiffness.transpose());
  return std::sqrt(
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(symmetric, Eigen::EigenvaluesOnly).eigenvalues()[n - 1]);
}

}  // namespace ropewalk
