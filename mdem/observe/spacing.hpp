// How far apart the tubes of a rope lie.
#pragma once

#include "observe/observe.hpp"

namespace ropewalk {

// Mean distance (nm) of an inner tube from its six nearest, at its middle, each distance to the line through the
// centres of a tube's elements; of two tubes, from the middle of either. Two tubes need no shells; 0 for one tube
// and for a rope without inner tubes.
double tube_spacing(const Topology& topology, const State& state, const RopeShells& shells);

}  // namespace ropewalk
