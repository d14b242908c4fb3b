// What a step moves.
#pragma once

#include "sim/simulation.hpp"

namespace ropewalk {

// Bytes that a step in the middle of several reads and writes of what is there for all elements, each array once
// for each: the least that goes to and from memory where nothing of it stays in a cache. Rows of nodes and whatever
// else a thread works in are not in it.
double step_bytes(const Simulation& simulation);

}  // namespace ropewalk
