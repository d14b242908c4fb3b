// The spacing of the tubes of a rope.
#pragma once

#include "observe/observe.hpp"

namespace ropewalk {

// Mean distance (nm) from the middle of an inner tube to its six nearest tubes, that is to the polylines through
// the centres of their elements. For two tubes: the mean of the distances from the middle of either to the other,
// without use of the shells. 0 for one tube and for a rope without inner tubes.
double tube_spacing(const Topology& topology, const State& state, const RopeShells& shells);

}  // namespace ropewalk
