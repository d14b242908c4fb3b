// The loops of the integrator over the elements begin .. end - 1: kicks, free motion over a step, how fast all are
// and how far they have come. A number that is not finite gives others that are not; nothing is looked for here.
#pragma once

#include <algorithm>
#include <cstddef>

#include "sim/state/state.hpp"

namespace ropewalk {

//   v += by F
void kick_elements(const Vec3Array& force, double by, Vec3Array& velocity, std::ptrdiff_t begin,
                   std::ptrdiff_t end);

//   x += v dt,   q <- exp(w dt) q     for turns w dt of up to half a radian
void move_elements(State& state, double dt, std::ptrdiff_t begin, std::ptrdiff_t end);

// The same with the turn by fourth-order Runge-Kutta of dq/dt = (w/2) q, its norm restored after the step, as PFC3D
// does it: for comparison. With isotropic inertia Euler's equations leave w alone between the kicks, whose torque
// is that of one place for a whole step. S. M. Johnson, J. R. Williams, B. K. Cook, Int. J. Numer. Meth. Eng. 74,
// 1303 (2008), DOI 10.1002/nme.2210.
void move_elements_runge_kutta(State& state, double dt, std::ptrdiff_t begin, std::ptrdiff_t end);

// The largest squares of speed (nm^2/ps^2) and of angular speed (1/ps^2), and the sum of all, which alone tells
// where one is not finite.
struct Fastest {
  double speed2 = 0, spin2 = 0, sum = 0;
};
Fastest fastest(const State& state, std::ptrdiff_t begin, std::ptrdiff_t end);

// A motion that leaves the distances within a cross-section alone: about the line along z through (x, y), by the
// angle whose sine is sine + slope (z - middle), held within `most`.
struct TwistOfAll {
  static constexpr double most = 0.14;
  double x = 0, y = 0, middle = 0;  // nm
  double sine = 0, slope = 0;       // slope in 1/nm
};

// How far (nm) any point of an element within `lever` of its centre is at most from where `twist` has brought it
// from `position` and `axis`, how much any axis is off likewise, and the sum of the former, which alone tells where
// a place is not finite. `spin` adds up the products of places before and now that give the twist its sine,
// `spin_z` the same times z.
struct Change {
  double moved = 0, turned = 0, sum = 0;
  double spin = 0, spin_z = 0;  // nm^2, nm^3
};
Change largest_change(const State& state, const Vec3Array& position, const Vec3Array& axis, double lever,
                      const TwistOfAll& twist, std::ptrdiff_t begin, std::ptrdiff_t end);
inline Change both(const Change& a, const Change& b) {
  return {std::max(a.moved, b.moved), std::max(a.turned, b.turned), a.sum + b.sum, a.spin + b.spin,
          a.spin_z + b.spin_z};
}

}  // namespace ropewalk
