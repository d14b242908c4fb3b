// What a step moves.
#pragma once

#include "sim/dynamics/simulation.hpp"

namespace ropewalk {

// Bytes of the arrays that every step goes through, each once where it is read and once where it is written: the
// state, axes, what the kernel walks of the list, contact buffers, and forces where they are stored. About the
// least that passes memory where nothing stays in a cache; not the rows of nodes and whatever else a thread works
// in, nor single runs and plans of twisted ropes, nor the places at the last build.
double step_bytes(const Simulation& simulation);

}  // namespace ropewalk
