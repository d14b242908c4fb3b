// What `plan` prints.
#pragma once

#include "plan/planner.hpp"

namespace ropewalk {

// All models that were tried. `seconds`: processor time of all pilots.
void print_pilots(const Plan& plan, double seconds);
// The chosen one, and what it promises.
void print_choice(const Plan& plan, const PlanRequest& request);

}  // namespace ropewalk
