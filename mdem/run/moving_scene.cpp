#include "run/moving_scene.hpp"

namespace ropewalk {

EnergyAccount account_of(const Scene& scene, const Simulation& simulation, const Energies& first,
                         double first_energy) {
  const State& s = simulation.state();
  EnergyAccount account;
  account.time_step = simulation.time_step() / simulation.divided();
  if (const MomentRamp* ramp = scene.moment_ramp()) account.moment = ramp->moment_at(s.time);
  account.potential = simulation.forces().energy;
  account.terms = term_energies(simulation.interaction(), simulation.forces().term_energy);
  account.kinetic = kinetic_energy(simulation.topology(), s);
  account.work = simulation.work();
  account.dissipated = simulation.dissipated();
  account.heat = simulation.heat();
  account.first_energy = first_energy;
  account.first = first;
  return account;
}

MovingScene::MovingScene(Scene of)
    : scene(std::move(of)),
      prepared(prepare(scene)),
      observer(make_observer(scene, prepared)),
      simulation(start(scene, prepared)),
      first(simulation.forces().energy),
      first_energy(simulation.total_energy()) {}

EnergyParts MovingScene::energies() const {
  return {simulation.forces().energy, kinetic_energy(prepared.topology, simulation.state())};
}

LogRow MovingScene::row() {
  EnergyAccount now = account();
  now.ends = simulation.read_gauges();
  return log_row(observer, scene, prepared.topology, simulation.state(), now);
}

}  // namespace ropewalk
