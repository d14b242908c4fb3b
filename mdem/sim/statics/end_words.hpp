// Why a search for a state of rest ended without one, and what to do, in words.
#pragma once

#include <string>

#include "sim/statics/newton.hpp"

namespace ropewalk {

// A bond that has left the window of its data, or is about to slip, in words; empty: there is none.
std::string overloaded_bond(const Simulation& simulation);

struct EndWords {
  std::string why, remedy;  // no remedy: more steps may help
};
// `by_fire`: FIRE had its part; `on_curve`: it went from a state of rest to the next load.
EndWords end_words(const Simulation& simulation, const Statics& end, bool by_fire, bool on_curve);

}  // namespace ropewalk
