// A run whose elements were split goes on in another one (run/stages.hpp).
#pragma once

#include "run/run_parts.hpp"

namespace ropewalk {

// State, time, account and record of the run before the splitting. Steps are counted as if it had been this fine
// from the start; the balance of energy goes on from its value, since the jump is no error of integration. Returns
// the record of the splitting, which `fine` has in its limits.
RefinementRecord go_on_finer(const RunParts& coarse, RunParts& fine);

// Says in a line how the run was refined. `to`: where it goes on.
std::string refinement_words(const RefinementRecord& split, const RunDirectory& to);

}  // namespace ropewalk
