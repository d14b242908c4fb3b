// The observables: everything that a run logs. One table; an entry is a column of log.csv, a key of
// `observe --json`, a column of its console, a row of the report and a line of docs/outputs.md.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "observe/loading.hpp"
#include "observe/observe.hpp"
#include "observe/rope_size.hpp"
#include "sim/forces/force_term.hpp"
#include "sim/state/interaction.hpp"
#include "sim/state/state.hpp"

namespace ropewalk {

// Loads and energies at one time. Only the run itself knows them; frames do not store them.
struct EnergyAccount {
  double time_step = 0;  // ps
  double moment = 0;     // eV, prescribed at the ends
  Energies potential;
  double kinetic = 0;       // eV
  double work = 0;          // eV, done by the loads since the start
  double dissipated = 0;    // eV, taken out by damping since the start
  double heat = 0;          // eV, brought in by the thermostat since the start
  double first_energy = 0;  // eV, total at the start
  Energies first;           // potential at the start
  struct Period {
    Energies potential, first;
  };
  std::optional<Period> period;              // the same of one period of a slice, which RopeSize::mass counts
  std::map<std::string, TermReading> terms;  // readings of the force terms by their names
  EndReadings ends;                          // means since the row before
};

// The part of what was dissipated (eV) that numerical damping has taken: all but what force terms have lost.
double lost_to_damping(const EnergyAccount& account);
// The error of the integration: total energy less its first value and what has been supplied, eV.
double energy_balance(const EnergyAccount& account);
// That error over the energy that has moved: kinetic energy, work, heat, what was dissipated and the change of the
// potential energy. Rounding of the energies that stay does not count. NaN where the energies are not known.
double energy_drift(const EnergyAccount& account);

// The input of an observable.
struct Measurement {
  const Topology& topology;
  const State& state;
  const RopeObservation& rope;
  const Loading& loading;
  const RopeSize& size;
  const EnergyAccount& account;
};

enum class ObservableGroup { time, load, energy, tubes, twist, packing, shape, limits };
const char* group_title(ObservableGroup group);
// Whether the group can be computed from a stored frame. Loads and energies are known only to the run itself.
bool in_frames(ObservableGroup group);

struct Observable {
  std::string name;     // ends in the unit, "moment_nN_nm", "area_nm2", "rate_per_ps": header and key of JSON
  std::string unit;     // "nN nm", "nm^2", "1/ps"; empty: a pure number
  std::string meaning;  // one clause, without a full stop
  ObservableGroup group = ObservableGroup::shape;
  std::function<double(const Measurement&)> value;  // in `unit`
  bool whole = false;                               // an integer
  std::string label = {};  // of an axis or a line, without the unit: "torque, upper end"; empty: the name in words
};

// Its label, or its name in words and without the unit: "ply angle" of ply_angle_deg.
std::string quantity_of(const Observable& observable);

// All observables, in the order of the columns.
const std::vector<Observable>& observables();

// Adds a column behind the others; call it before anything is logged or read. Throws std::invalid_argument if the
// name is taken, has characters other than letters, digits and _, or does not end in the unit.
void add_observable(const Observable& observable);

// The columns NAME_eV of the force terms, which follow from term_kinds() by themselves.
std::vector<std::string> term_energy_columns();

// Index in observables(). Throws std::invalid_argument if no observable has this name.
std::size_t index_of_observable(std::string_view name);

// The table in Markdown, as in docs/outputs.md.
std::string observables_markdown();

}  // namespace ropewalk
