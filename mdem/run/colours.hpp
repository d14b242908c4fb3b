#pragma once

#include "io/frames/colours.hpp"
#include "sim/state/interaction.hpp"

namespace ropewalk {

// Per-element energies, bending moment and twist of a state, for frames and pictures.
ElementColours element_colours(const Topology& topology, const Interaction& interaction, const State& state);

}  // namespace ropewalk
