// limits.json of a run: its limits, the largest value of each, and the refinements: the runs that it came from or
// goes on in if elements were split.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "io/outputs.hpp"
#include "sim/state/interaction.hpp"

namespace ropewalk {

struct LimitRecord {
  std::string key;   // as in the scene's [limits]
  std::string unit;  // may be empty
  double limit = 0;  // in that unit; 0: not watched
  double largest = 0;
  double largest_at_ps = 0;
  int tube = -1;     // of the largest value; -1: no value
  int element = -1;  // of the largest value, counted in the tube from 0; for a bond its first element
  bool passed = false;
  double passed_at_ps = 0;
  std::int64_t passed_at_step = 0;
};

// Energies of a state, by kind (eV).
struct EnergyParts {
  Energies potential;
  double kinetic = 0;

  double total() const { return potential.potential() + kinetic; }
};

// One splitting of all elements.
struct RefinementRecord {
  std::string from, to;  // names of the directories, which stand side by side
  double time_ps = 0;
  std::int64_t step_before = 0, step_after = 0;
  double length_before = 0, length_after = 0;  // of an element, nm
  int elements_before = 0, elements_after = 0;
  EnergyParts before, after;
};

struct LimitsFile {
  std::vector<LimitRecord> limits;
  std::vector<RefinementRecord> refinements;  // of this run and the runs before it, in order of time
};

// Keys of an entry of "limits", of an entry of "refinements", and of the energies in the latter.
std::vector<OutputColumn> limit_keys();
std::vector<OutputColumn> refinement_keys();
std::vector<OutputColumn> energy_keys();

std::string limits_json(const LimitsFile& file);

// Throws InputError for a file that is missing, not JSON, or lacks a key.
LimitsFile read_limits(const std::string& path);
// The same of its text; `path` is named in errors.
LimitsFile limits_of_text(const std::string& text, const std::string& path);

}  // namespace ropewalk
