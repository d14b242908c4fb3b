// Memory traffic of a step.
#pragma once

#include "sim/dynamics/simulation.hpp"

namespace ropewalk {

// Bytes of the arrays that every step reads or writes, counted once for reading and once for writing: the state,
// axes, neighbour spans, contact buffers, and forces if they are stored. This is about the least traffic if nothing
// stays in a cache. Not counted: scratch memory of the threads, and the positions at the last build of the list.
double step_bytes(const Simulation& simulation);

}  // namespace ropewalk
