#include "plan/energy_check.hpp"

#include <cmath>

#include "scene/random.hpp"
#include "sim/dynamics/tangent.hpp"

namespace ropewalk {
namespace {

constexpr double shaken = 0.01, step = 1e-5;  // nm and rad

Eigen::VectorXd random_motion(std::size_t elements, double size, Random& random) {
  Eigen::VectorXd out(6 * static_cast<Eigen::Index>(elements));
  for (double& number : out) number = size * random.normal();
  return out;
}

}  // namespace

double EnergyCheck::error() const { return std::fabs(by_energy - by_forces) / size; }

EnergyCheck energy_check(const Simulation& simulation) {
  Interaction interaction = simulation.interaction();
  interaction.precision = Interaction::Precision::full;
  ForceEngine engine;
  engine.take_terms_of(simulation.engine());
  const std::size_t elements = simulation.state().size();
  Forces forces(elements);
  const auto energy = [&](const State& state) {
    engine.compute(simulation.topology(), interaction, simulation.list(), state, forces);
    return forces.energy.potential();
  };
  Random random(1);
  const State at = moved(simulation.state(), random_motion(elements, shaken, random));
  const Eigen::VectorXd motion = random_motion(elements, 1, random);
  const double ahead = energy(moved(at, step * motion)), behind = energy(moved(at, -step * motion));
  EnergyCheck out;
  out.by_energy = (behind - ahead) / (2 * step);
  energy(at);
  for (std::size_t i = 0; i < elements; ++i) {
    const auto row = 6 * static_cast<Eigen::Index>(i);
    const double push = forces.force[i].dot(motion.segment<3>(row)),
                 turn = forces.torque[i].dot(motion.segment<3>(row + 3));
    out.by_forces += push + turn;
    out.size += std::fabs(push) + std::fabs(turn);
  }
  return out;
}

}  // namespace ropewalk
