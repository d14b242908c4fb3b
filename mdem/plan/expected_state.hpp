// How a rope will look that is twisted, before it is.
#pragma once

#include "scene/prepare.hpp"

namespace ropewalk {

// The straight parallel tubes of a rope along z laid in helices of the same length, turned by `turn` (rad/nm) about
// the middle of the rope, with the velocities of a turn that grows by `rate` (rad/(nm ps)): what a slow twist makes
// of a rope whose tubes slide freely.
State turned_rope(const Prepared& prepared, double turn, double rate);

}  // namespace ropewalk
