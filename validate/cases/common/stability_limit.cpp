#include "cases/common/stability_limit.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>

#include "model/error.hpp"
#include "scene/random.hpp"
#include "sim/forces/forces.hpp"

namespace ropewalk::validate {
namespace {

constexpr double enough_growth = 1e6;  // factor of the kinetic energy that counts as unstable

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

double largest_step(const Topology& topology, const Interaction& interaction, const State& state, double about) {
  return limit_between([&](double dt) { return blows_up(topology, interaction, state, dt); }, 0.3 * about,
                       3 * about);
}

namespace {

// Minus the derivative of all forces and torques by positions and rotations, or by velocities, over the masses.
enum class By { position, velocity };
Eigen::MatrixXd derivative(const Topology& topology, const Interaction& interaction, const State& state, By by) {
  const auto n = static_cast<Eigen::Index>(6 * state.size());
  const double h = by == By::position ? 1e-5 : 1e-3;  // nm, rad; nm/ps, rad/ps
  NeighbourList list(interaction, 0.2);
  list.build(topology, state);
  ForceEngine engine;
  const auto forces = [&](Eigen::Index freedom, double change) {
    State moved = state;
    const auto i = static_cast<std::size_t>(freedom / 6);
    const Vector3 along = change * Vector3::Unit(freedom % 3);
    const bool moves = freedom % 6 < 3;
    if (by == By::velocity) {
      (moves ? moved.velocity : moved.angular_velocity).add(i, along);
    } else if (moves) {
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
  Eigen::VectorXd root(n);  // square roots of mass and inertia
  for (Eigen::Index k = 0; k < n; ++k) {
    const TubeType& type = topology.type_of_element(static_cast<int>(k / 6));
    root[k] = std::sqrt(k % 6 < 3 ? type.mass : type.inertia);
  }
  Eigen::MatrixXd out(n, n);
  for (Eigen::Index k = 0; k < n; ++k) out.col(k) = (forces(k, -h) - forces(k, h)) / (2 * h);
  out = root.cwiseInverse().asDiagonal() * out * root.cwiseInverse().asDiagonal();
  return 0.5 * (out + out.transpose());
}

double largest_eigenvalue(const Eigen::MatrixXd& m) {
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(m, Eigen::EigenvaluesOnly).eigenvalues().maxCoeff();
}

}  // namespace

CaseFigure step_figure(const std::string& by, const ChartAxis& x, std::string caption,
                       std::vector<ChartLine> lines) {
  CaseFigure figure =
      case_figure("Largest stable step by " + by, x, {"largest step", "fs"}, std::move(caption), std::move(lines));
  figure.chart.below = "stable";
  figure.chart.above = "unstable";
  figure.on_map = true;
  return figure;
}

double stiffest_frequency(const Topology& topology, const Interaction& interaction, const State& state) {
  return std::sqrt(largest_eigenvalue(derivative(topology, interaction, state, By::position)));
}

double largest_damped_step(const Topology& topology, const Interaction& interaction, const State& state) {
  const Eigen::MatrixXd k = derivative(topology, interaction, state, By::position),
                        d = derivative(topology, interaction, state, By::velocity);
  return limit_between([&](double dt) { return largest_eigenvalue(dt * dt * k + 2 * dt * d) > 4; }, 1e-5, 0.5,
                       1e-3);
}

}  // namespace ropewalk::validate
