// A state at which Newton's method has ended, as tables have it.
#pragma once

#include "io/equilibria.hpp"

namespace ropewalk {

struct Statics;
struct StabilityVerdict;

// Without step and time.
Equilibrium equilibrium_of(const Statics& end, const StabilityVerdict& verdict);

}  // namespace ropewalk
