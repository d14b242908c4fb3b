// The moment that drives prescribe at the ends of a rope, against what its bonds bear.
#pragma once

#include "scene/scene.hpp"

namespace ropewalk {

// A couple on the last element of a tube goes through its last bond. A single tube bears it in every bond. Throws
// InputError at `key` for a moment that is more; `loads` are those of all drives.
void refuse_end_moment(const Scene& scene, const Topology& topology, const LoadsAndConstraints& loads,
                       const char* key);

}  // namespace ropewalk
