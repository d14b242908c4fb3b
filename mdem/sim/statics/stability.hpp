// Whether a state at rest is stable: the fastest growth of a small motion, by the modes of its tangent
// (sim/dynamics/modes.hpp), which hold under loads without a potential as well.
#pragma once

#include <optional>
#include <string>

#include "sim/dynamics/simulation.hpp"

namespace ropewalk {

struct Stability {
  double growth = 0;   // 1/ps: the largest real part of a rate; negative: all motions decay
  double neutral = 0;  // 1/ps: smaller ones cannot be told from zero
  bool stable() const { return growth <= neutral; }
};

// Returns nothing, and the reason in `why`, where constraints tie several elements, a term has no tangent, the
// decomposition would take more than `most_bytes`, or no eigenvalue was found.
std::optional<Stability> stability_of(const Simulation& simulation, double most_bytes, std::string& why);

}  // namespace ropewalk
