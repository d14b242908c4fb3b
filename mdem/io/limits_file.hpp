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
  // Limit and largest value are in `unit`, and below zero where a bond is pressed; a limit of 0 is not watched.
  double limit = 0;
  double largest = 0;
  double largest_at_ps = 0;
  int tube = -1;     // tube with the largest value; -1: no value
  int element = -1;  // element with the largest value, counted in the tube from 0; for a bond its first element
  bool passed = false;
  double passed_at_ps = 0;
  std::int64_t passed_at_step = 0;
  int passed_tube = -1, passed_element = -1;  // where it was passed first, counted likewise; -1: at no element
  std::string passed_held_by = {};            // what holds that place: "the upper clamp"; empty: nothing
};

// The limit that was passed first; null: none was.
const LimitRecord* first_limit(const std::vector<LimitRecord>& limits);
// "from 243 ps on", or, in a relaxation, "from step 120 on".
std::string since_words(const LimitRecord& passed);
// "tube 25, element 44, at the upper clamp"; empty for the run as a whole.
std::string place_words(const LimitRecord& passed);
// "beyond wall_twist from 243 ps on", of the limit that was passed first; empty: none was.
std::string beyond_words(const std::vector<LimitRecord>& limits);
// The same as a sentence or two, with the place and what is wrong there; empty: none was.
std::string beyond_sentence(const std::vector<LimitRecord>& limits);
// How a run ended and whether it is beyond a limit: "finished, beyond wall_twist from 243 ps on".
std::string status_words(const std::string& status, const std::vector<LimitRecord>& limits);
// The largest value over its limit, of the limits that were passed; 0: none was. Beyond `far_beyond` the results of
// a run are not those of the tubes.
double beyond_limits(const std::vector<LimitRecord>& limits);
inline constexpr double far_beyond = 3;
// "wall_twist reached 3.63 times its limit", of the one that was passed by most; empty: none was.
std::string worst_words(const std::vector<LimitRecord>& limits);

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
  double length_before = 0, length_after = 0;  // lengths of an element, nm
  int elements_before = 0, elements_after = 0;
  EnergyParts before, after;
};

struct LimitsFile {
  std::vector<LimitRecord> limits;
  std::vector<RefinementRecord> refinements;  // refinements of this run and the runs before it, in order of time
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
