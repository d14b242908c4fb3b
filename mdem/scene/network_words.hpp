// How the tubes of a film hang together, in words.
#pragma once

#include <string>

#include "sim/state/state.hpp"

namespace ropewalk {

struct Scene;

// Tubes touch where their axes are closer than this many times the distance at which two crossed tubes bind best.
inline constexpr double touching = 1.1;

// Contacts of a tube, the largest cluster, and whether one spans the box of the scene's kind: it then joins two
// electrodes that cover the box for half the length of a tube from either side. The box stays where it was at the
// start. Empty for a scene without a box.
std::string network_words(const Scene& scene, const Topology& topology, const State& state);

}  // namespace ropewalk
