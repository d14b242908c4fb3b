// A state file and the memory beside it (scene/state_memory.hpp), from a simulation and back into the terms of a
// scene.
#pragma once

#include <string>
#include <vector>

#include "scene/state_memory.hpp"
#include "sim/dynamics/simulation.hpp"

namespace ropewalk {

// `memory` is empty where nothing is remembered.
struct StateFiles {
  std::string state, memory;
};
// For a state file of this path.
StateFiles state_files(const Simulation& simulation, const std::string& state_path);

// The terms of a scene begin with the memory of its state file. Throws InputError where that would be another one
// than they have, or where it is missing.
void begin_with(const StateMemory& memory, const Topology& topology, Interaction& interaction);
// One sentence for each force term that begins without a stored state, and for each stored state that no term uses.
std::vector<std::string> forgotten(const StateMemory& memory, const Interaction& interaction);

}  // namespace ropewalk
