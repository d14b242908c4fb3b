// Free motion of all elements over a step: the only part of the integrator with more than a line of arithmetic.
#pragma once

#include <cstddef>

#include "sim/state.hpp"

namespace ropewalk {

//   x += v dt,   q <- exp(w dt) q     for the elements begin .. end - 1
// A velocity that is not finite gives places that are not; nothing is looked for here.
void move_elements(State& state, double dt, std::ptrdiff_t begin, std::ptrdiff_t end);

}  // namespace ropewalk
