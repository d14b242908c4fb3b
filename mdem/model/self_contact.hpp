// How near two points of one tube can come, by their distance s along it. Of all curves that are nowhere curved
// more than kappa, the circle of that curvature brings the ends of an arc nearest to one another (Schur's theorem;
// S. S. Chern, in Studies in Global Geometry and Analysis (1967)):
//
//   chord(s) >= (2/kappa) sin(kappa s/2)   for s <= 2 pi/kappa
//
// Points within a distance d < 2/kappa are therefore either those of one and the same nearly straight piece, s <=
// nearest_arc(), or s is at least that of the smallest loop, smallest_loop(). Lengths in nm, kappa in 1/nm.
#pragma once

#include <algorithm>
#include <cmath>

#include "model/units.hpp"

namespace ropewalk {

// Half a circle where d >= 2/kappa: the circle is no wider than d.
inline double nearest_arc(double kappa, double d) {
  return kappa > 0 ? 2 / kappa * std::asin(std::min(1.0, 0.5 * kappa * d)) : d;
}
// Infinite for a tube that cannot be bent.
inline double smallest_loop(double kappa, double d) { return 2 * units::pi / kappa - nearest_arc(kappa, d); }

}  // namespace ropewalk
