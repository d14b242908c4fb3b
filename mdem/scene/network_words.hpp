// How the tubes of a film hang together, in words.
#pragma once

#include <string>

#include "sim/state/state.hpp"

namespace ropewalk {

struct Scene;

// Tubes touch where their axes are closer than this many times the distance at which two crossed tubes bind best.
inline constexpr double touching = 1.1;

// A sentence: the contacts of a tube, the largest cluster, and whether a cluster spans the box of the scene's kind.
// A cluster that spans the box joins two electrodes, each of which covers half the length of a tube at one side of
// the box. The box does not move with the tubes. Empty for a scene without a box.
std::string network_words(const Scene& scene, const Topology& topology, const State& state);

}  // namespace ropewalk
