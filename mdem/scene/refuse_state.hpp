// Checks of a state, the same in every verb that evaluates, moves or measures it.
#pragma once

#include "model/error.hpp"
#include "sim/forces/forces.hpp"

namespace ropewalk {

// Throws InputError at `place` where elements lie inside of one another: they would go apart like an explosion, or
// pass through each other unseen. `may_part`: a relaxation may part tubes, but not those that lie side by side on
// one axis, walls of a multi-walled tube.
void refuse_overlaps(const Topology& topology, const Interaction& interaction, const State& state,
                     const InputError::Place& place, bool may_part);

// Throws InputError at `place` where the forces of a state mean nothing: a bond is twisted by 90 degrees or more,
// where it slips, or a force is no finite number.
void refuse_forces(const Forces& forces, const InputError::Place& place);

}  // namespace ropewalk
