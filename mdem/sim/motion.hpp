// Free motion of all elements over a step, the only part of the integrator with more than a line of arithmetic; and
// how far it has brought them.
#pragma once

#include <algorithm>
#include <cstddef>

#include "sim/state.hpp"

namespace ropewalk {

//   x += v dt,   q <- exp(w dt) q     for the elements begin .. end - 1
// A velocity that is not finite gives places that are not; nothing is looked for here.
void move_elements(State& state, double dt, std::ptrdiff_t begin, std::ptrdiff_t end);

// The same with the turn by fourth-order Runge-Kutta of dq/dt = (w/2) q, its norm restored after the step, as PFC3D
// does it: for comparison. With isotropic inertia Euler's equations leave w alone between the kicks, whose torque
// is that of one place for a whole step. S. M. Johnson, J. R. Williams, B. K. Cook, Int. J. Numer. Meth. Eng. 74,
// 1303 (2008), DOI 10.1002/nme.2210.
void move_elements_runge_kutta(State& state, double dt, std::ptrdiff_t begin, std::ptrdiff_t end);

// How far (nm) any point of an element within `lever` of its centre has moved at most since `position` and `axis`,
// how much any axis has changed, and the sum of the former, which alone tells where a place is not finite.
struct Change {
  double moved = 0, turned = 0, sum = 0;
};
Change largest_change(const State& state, const Vec3Array& position, const Vec3Array& axis, double lever,
                      std::ptrdiff_t begin, std::ptrdiff_t end);
inline Change farther(const Change& a, const Change& b) {
  return {std::max(a.moved, b.moved), std::max(a.turned, b.turned), a.sum + b.sum};
}

}  // namespace ropewalk
