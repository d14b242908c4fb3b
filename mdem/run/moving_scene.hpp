// A scene in motion, and the account of its energy since the start.
#pragma once

#include <optional>

#include "io/limits_file.hpp"
#include "run/run_directory.hpp"
#include "sim/dynamics/step_control.hpp"

namespace ropewalk {

// Energies of one period of a slice: bonds that begin with an element of its own, half of each contact that such an
// element has, and as large a share of the force terms as its elements are of all. None: no slice.
std::optional<Energies> energies_of_period(const Simulation& simulation);

// Without the forces at the ends and without the period of a slice, which costs as much as some steps. `first`,
// `first_energy` (eV): potential and total energy at the start.
EnergyAccount account_of(const Simulation& simulation, const Energies& first, double first_energy);

// Throws InputError for a [[stop]] rule whose column has no value in the first row: it would never fire.
void refuse_stops_without_value(const Scene& scene, const LogRow& first);

struct MovingScene {
  explicit MovingScene(Scene of);

  const State& state() const { return simulation.state(); }
  bool relaxes() const { return scene.run.mode == RunOptions::Mode::relax; }
  EnergyAccount account() const { return account_of(simulation, first, first_energy); }
  EnergyParts energies() const;
  bool looks_closely() const { return control.looks_closely(simulation.divided(), simulation.step_count()); }
  void lengthen_steps() { simulation.divide_steps(control.lengthen(simulation.divided(), simulation.step_count())); }
  // All observables. Forces at the ends are means since the last row.
  LogRow row();

  Scene scene;
  Prepared prepared;
  Observer observer;
  Simulation simulation;
  StepControl control;
  Energies first;
  std::optional<Energies> first_of_period;
  double first_energy = 0;
};

}  // namespace ropewalk
