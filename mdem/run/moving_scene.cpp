#include "run/moving_scene.hpp"

#include <cmath>

#include "model/error.hpp"
#include "run/colours.hpp"
#include "run/period_energies.hpp"
#include "scene/scene_place.hpp"
#include "sim/dynamics/end_drives.hpp"

namespace ropewalk {

std::optional<Energies> energies_of_period(const Simulation& simulation) {
  return energies_of_period(simulation.topology(), simulation.tubes_now(), simulation.interaction(),
                            simulation.state(), simulation.forces().energy.terms);
}

std::optional<Energies> energies_of_period(const Topology& topology, const Topology& now,
                                           const Interaction& interaction, const State& s, double terms) {
  if (topology.groups.images == 0) return std::nullopt;
  const std::vector<double> contacts = contact_energies(topology, interaction, s);
  Energies out;
  int own = 0;
  for (int t = 0; t < now.tubes(); ++t) {
    const TubeType& type = now.type_of(t);
    for (int e = now.tube_begin[t]; e < now.tube_begin[t + 1]; ++e) {
      if (topology.is_image(e)) continue;
      const auto i = static_cast<std::size_t>(e), j = i + 1;
      ++own;
      out.vdw += contacts[i];
      if (e + 1 == now.tube_begin[t + 1]) continue;
      const BondEnergy bond = bond_energy(type.bond, type.element_length, Vector3(s.position[j] - s.position[i]),
                                          frame_of(s.orientation[i]), frame_of(s.orientation[j]));
      out.stretch += bond.stretch, out.shear += bond.shear, out.bend += bond.bend, out.twist += bond.twist;
    }
  }
  out.terms = terms * own / topology.elements();
  return out;
}

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
  for (std::size_t k = 0; k < scene.stops.size(); ++k) {
    const StopRule& rule = scene.stops[k];
    const bool shape = rule.when == StopRule::When::shape;
    const std::string column = shape ? "radius_mid_nm" : rule.column;
    if (!column.empty() && std::isnan(first[column]))
      throw InputError(place_in(scene, shape ? "stop.shape" : "stop.column", static_cast<int>(k)),
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
      first_of_period(energies_of_period(simulation)),
      first_energy(simulation.total_energy()) {}

EnergyParts MovingScene::energies() const {
  return {simulation.forces().energy, kinetic_energy(prepared.topology, simulation.state())};
}

LogRow MovingScene::row() {
  EnergyAccount now = account();
  now.ends = simulation.read_gauges();
  if (first_of_period) now.period = EnergyAccount::Period{*energies_of_period(simulation), *first_of_period};
  return log_row(observer, scene, simulation.tubes_now(), simulation.state(), now);
}

}  // namespace ropewalk
