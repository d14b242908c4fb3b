// Where a rope rests under a moment, for small angles: theory of the winding of N parallel tubes whose ends are
// free.
//
// A couple M on each tube, of fixed direction, winds the rope by p per length with the force (per length, over
// 2 S, S = sum of rho^2 over the tubes)
//
//   M p^2 - X p^3,   X = EI + 2 c4/S,   c4 = 9 pi Y R^6/384
//
// c4 p^4 is the crowding energy per length of a lattice with Young's modulus Y = 2 k/sqrt(3) on a disc of the
// radius R (G. M. Grason, Rev. Mod. Phys. 87, 401 (2015), DOI 10.1103/RevModPhys.87.401); k is the stiffness per
// length of a pair of neighbours. A compact rope rests at p = M/X: 0.82, 0.81, 0.88 and 0.99 of what 7, 19, 37 and
// 91 published tubes of 67.8 nm come to under 35 nN nm. In an open rope the tubes have parted and do not crowd
// each other. Each tube then bends as a free rod into a helix that turns by p = M/EI per length of the tube.
#pragma once

#include "scene/prepare.hpp"

namespace ropewalk {

struct RestTheory {
  double compact = 0, open = 0;  // twist under the moment that the scene ends with, rad/nm
};
// Throws InputError where the scene is no rope whose ends a moment turns and nothing else holds.
RestTheory rest_theory(const Scene& scene, const Prepared& prepared);

}  // namespace ropewalk
