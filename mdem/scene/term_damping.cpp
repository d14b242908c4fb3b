#include "scene/term_damping.hpp"

#include <cmath>

#include "model/units.hpp"
#include "scene/random.hpp"
#include "sim/dynamics/simulation.hpp"

namespace ropewalk {
namespace {

State with_heat(const Topology& topology, State state, double temperature, Random& random) {
  const double kT = units::boltzmann * temperature;
  const auto any = [&](double inertia) -> Vector3 {
    return std::sqrt(kT / inertia) * Vector3(random.normal(), random.normal(), random.normal());
  };
  for (std::size_t i = 0; i < state.size(); ++i) {
    const TubeType& type = topology.type_of_element(static_cast<int>(i));
    state.velocity.set(i, any(type.mass));
    state.angular_velocity.set(i, any(type.inertia));
  }
  return state;
}

State reversed(State state) {
  for (std::size_t i = 0; i < state.size(); ++i) {
    state.velocity.set(i, -state.velocity[i]);
    state.angular_velocity.set(i, -state.angular_velocity[i]);
  }
  return state;
}

}  // namespace

std::vector<TermDamping> damping_of_terms(const Topology& topology, const Interaction& in, const State& state,
                                          double temperature) {
  constexpr int draws = 4;
  std::vector<TermDamping> out;
  for (const auto& term : in.terms) {
    Interaction alone = in;
    alone.terms = {term};
    alone.damping = {};
    NeighbourList list(alone, default_skin(alone));
    list.build(topology, state);
    ForceEngine engine;
    Random random(1);
    double power = 0, kinetic = 0;
    for (int k = 0; k < draws; ++k) {
      const State there = with_heat(topology, state, temperature, random);
      Forces one(state.size()), other(state.size());
      engine.compute(topology, alone, list, there, one, {Parts::all, false, {}});
      engine.compute(topology, alone, list, reversed(there), other, {Parts::all, false, {}});
      for (std::size_t i = 0; i < state.size(); ++i)
        power -= 0.5 * ((one.force[i] - other.force[i]).dot(there.velocity[i]) +
                        (one.torque[i] - other.torque[i]).dot(there.angular_velocity[i]));
      kinetic += kinetic_energy(topology, there);
    }
    if (power > 0) out.push_back({term->name(), 0.5 * power / kinetic});
  }
  return out;
}

}  // namespace ropewalk
