// Loops of the integrator over elements begin .. end - 1: kicks, free motion over a step, largest speeds, and
// displacements. Numbers that are not finite are not checked for here; they propagate to the results.
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

// The same with a rotation by fourth-order Runge-Kutta of dq/dt = (w/2) q, normalised after the step, as PFC3D does
// it: for comparison. With isotropic inertia w is constant between the kicks. S. M. Johnson, J. R. Williams, B. K.
// Cook, Int. J. Numer. Meth. Eng. 74, 1303 (2008), DOI 10.1002/nme.2210.
void move_elements_runge_kutta(State& state, double dt, std::ptrdiff_t begin, std::ptrdiff_t end);

// The largest squared speed (nm^2/ps^2), the largest squared angular speed (1/ps^2), and the sum of all squares.
// Only the sum is sure to be NaN or infinite if a velocity is: std::max may drop a NaN.
struct Fastest {
  double speed2 = 0, spin2 = 0, sum = 0;
};
Fastest fastest(const State& state, std::ptrdiff_t begin, std::ptrdiff_t end);

// A common twist, which keeps the distances within a cross-section: a rotation about the line along z through (x,
// y) by an angle with the sine  sine + slope (z - middle),  limited to +-max_sine.
struct TwistOfAll {
  static constexpr double most = 0.14;
  double x = 0, y = 0, middle = 0;  // nm
  double sine = 0, slope = 0;       // slope in 1/nm
};

// Motion of elements beyond a common twist, from a reference position and axis:
//   moved   upper bound (nm) of the displacement of any point within `lever` of the centre of its element
//   sum     sum of the displacements over the elements; only the sum is sure to show a position that is not finite
//   spin, spin_z   sums from which the sine and the slope of the next common twist are fitted
struct Change {
  double moved = 0, sum = 0;
  double spin = 0, spin_z = 0;  // nm^2, nm^3
};
Change largest_change(const State& state, const Vec3Array& position, const Vec3Array& axis, double lever,
                      const TwistOfAll& twist, std::ptrdiff_t begin, std::ptrdiff_t end);
inline Change both(const Change& a, const Change& b) {
  return {std::max(a.moved, b.moved), a.sum + b.sum, a.spin + b.spin, a.spin_z + b.spin_z};
}

}  // namespace ropewalk
