// The observables: everything that a run logs. One table; an entry is a column of log.csv, a key of
// `observe --json`, a column of its console, a row of the report and a line of docs/outputs.md.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "observe/observe.hpp"
#include "sim/state/interaction.hpp"
#include "sim/state/state.hpp"

namespace ropewalk {

// Moment and energies at one time, as a run keeps them. Frames do not store them.
struct EnergyAccount {
  double moment = 0;  // eV, of the twist protocol
  Energies potential;
  double kinetic = 0;       // eV
  double work = 0;          // eV, done by the loads since the start
  double dissipated = 0;    // eV, taken out by damping since the start
  double heat = 0;          // eV, brought in by the thermostat since the start
  double first_energy = 0;  // eV, total at the start
};

// What an observable is computed from.
struct Measurement {
  const Topology& topology;
  const State& state;
  const RopeObservation& rope;
  const EnergyAccount& account;
};

enum class ObservableGroup { time, load, energy, twist, packing, shape, limits };
const char* group_title(ObservableGroup group);
// Can the group be measured of a stored frame? Loads and energies are known only to the run itself.
bool in_frames(ObservableGroup group);

struct Observable {
  std::string name;     // ends in the unit, "moment_nN_nm", "area_nm2", "rate_per_ps": header and key of JSON
  std::string unit;     // "nN nm", "nm^2", "1/ps"; empty: a pure number
  std::string meaning;  // one clause, without a full stop
  ObservableGroup group = ObservableGroup::shape;
  double (*value)(const Measurement&) = nullptr;  // in `unit`
  bool whole = false;                             // an integer
};

// In the order of the columns.
const std::vector<Observable>& observables();

// Adds a column behind the others; call it before anything is logged or read. Throws std::invalid_argument where
// the name is taken, has other characters than letters, digits and _, or does not end in the unit.
void add_observable(const Observable& observable);

// Place in observables(). Throws std::invalid_argument where there is none of this name.
std::size_t index_of_observable(std::string_view name);

// The table for people, in Markdown: as docs/outputs.md has it.
std::string observables_markdown();

}  // namespace ropewalk
