// Energies of one period of a slice, from a state without a simulation, as `import` has them.
#pragma once

#include <optional>

#include "sim/forces/forces.hpp"
#include "sim/state/interaction.hpp"
#include "sim/state/state.hpp"

namespace ropewalk {

// As energies_of_period() of moving_scene.hpp. `now`: the tubes, cut where they have broken; `terms`: eV, of all force
// terms.
std::optional<Energies> energies_of_period(const Topology& topology, const Topology& now,
                                           const Interaction& interaction, const State& state, double terms);

}  // namespace ropewalk
