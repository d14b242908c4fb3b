#pragma once

#include <vector>

#include "io/frames/colours.hpp"
#include "sim/state/interaction.hpp"

namespace ropewalk {

// Per-element energies, bending moment and twist of a state, for frames and pictures. `bonded`: the tubes where
// they have not broken (Simulation::tubes_now).
ElementColours element_colours(const Topology& topology, const Interaction& interaction, const State& state,
                               const Topology& bonded);
inline ElementColours element_colours(const Topology& topology, const Interaction& interaction,
                                      const State& state) {
  return element_colours(topology, interaction, state, topology);
}

// Half of the energy of each contact, for each element, eV.
std::vector<double> contact_energies(const Topology& topology, const Interaction& interaction, const State& state);

}  // namespace ropewalk
