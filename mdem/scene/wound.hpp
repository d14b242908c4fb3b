// Straight tubes wound about their common axis.
#pragma once

#include "sim/state/state.hpp"

namespace ropewalk {

// Straight parallel tubes along z laid in helices of the same length, turned by `turn` (rad/nm) along z about the
// middle of them all, with the velocities of a turn that grows by `rate` (rad/(nm ps)): what a slow twist makes of
// a rope whose tubes slide freely.
State wound(const State& straight, double turn, double rate = 0);

}  // namespace ropewalk
