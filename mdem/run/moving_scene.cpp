#include "run/moving_scene.hpp"

#include <cmath>

#include "model/error.hpp"
#include "sim/dynamics/end_drives.hpp"

namespace ropewalk {

EnergyAccount account_of(const Simulation& simulation, const Energies& first, double first_energy) {
  const State& s = simulation.state();
  EnergyAccount account;
  account.time_step = simulation.time_step() / simulation.divided();
  account.moment = moment_at(end_drives(simulation.loads(), simulation.topology()), s.time);
  account.potential = simulation.forces().energy;
  account.terms =
      term_readings(simulation.interaction(), simulation.forces().term_energy, simulation.term_accounts());
  account.kinetic = kinetic_energy(simulation.topology(), s);
  account.work = simulation.work();
  account.dissipated = simulation.dissipated();
  account.heat = simulation.heat();
  account.first_energy = first_energy;
  account.first = first;
  return account;
}

void refuse_stops_without_value(const Scene& scene, const LogRow& first) {
  for (const StopRule& rule : scene.stops) {
    const bool shape = rule.when == StopRule::When::shape;
    const std::string column = shape ? "radius_mid_nm" : rule.column;
    if (!column.empty() && std::isnan(first[column]))
      throw InputError({scene.path, 0, shape ? "stop.shape" : "stop.column"},
                       "\"" + column + "\" has no value in this scene, so that the rule would never stop it",
                       "take a column that has one; tubes that are not side by side have no centre line, a rope "
                       "without inner tubes no core, and one rope alone no ply angle");
  }
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
  return log_row(observer, scene, simulation.tubes_now(), simulation.state(), now);
}

}  // namespace ropewalk
