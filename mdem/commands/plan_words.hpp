// The output of `plan`.
#pragma once

#include "plan/planner.hpp"

namespace ropewalk {

// All models that were tried. `seconds`: processor time of all pilots.
void print_pilots(const Plan& plan, double seconds);
// The chosen model and its promised errors.
void print_choice(const Plan& plan, const PlanRequest& request);

}  // namespace ropewalk
