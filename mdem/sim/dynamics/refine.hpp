// The same rope on a finer chain, with elements of half the length.
//
//   whole     Every element is split into two, e into 2 e and 2 e + 1: n elements become 2 n, as long as before.
//   between   Another element comes between every two: n elements become 2 n - 1. All centres stay in place. A
//   drive
//             that holds an element thus holds the tube at the same place, and the length between two clamps stays.
//             A tube ends a quarter of an old element earlier.
//
// An element stands for the tube from half a length before its centre to half a length behind it, so that its
// halves have their centres a quarter of a length to either side: at the shares u = 1/4 and 3/4 of the bonds. One
// between two is at u = 1/2.
// Between two neighbours i, j (r = x_j - x_i, m the mean of their axes, theta their angle) the rod is taken as what
// the bond says that it is, a Timoshenko beam bent by end loads:
//
//   bend   t(u) = t_i turned by u theta towards t_j: a circular arc, x(u) = x_i + L u sinc(u theta/2) t(u/2)
//   twist  u times that of the bond, about t(u)
//   shear  sigma = r - (r.m) m, the part of r across the arc. Of it 1 - s is shear of the rod, the same all along;
//          s (shear_share() of model/bond.hpp) is due to a curvature that changes along the bond:
//          x += sigma (u + s (3 u^2 - 2 u^3 - u)),   t turned by 6 s u (1 - u) sigma/L
//
// A straight, stretched, twisted or circular chain is carried over exactly, and so is the centre line where twist
// is added; any other one with an error of higher order in the element length. Beyond the last centres the rod goes
// on with the curvature, twist and strain of the last bond. In twist every bond counts: n - 1 bonds of angle phi
// become 2 n - 1 of phi/2 where elements are split whole, since half a length more of the tube is now free to
// twist, and 2 n - 2 where they come between.
//
// Velocities follow from the same map under the motion of the coarse elements, so that a rigid motion stays rigid.
// Splitting::whole keeps the mass of each tube. It also keeps the linear and the angular momentum: it adds to each
// tube the rigid motion that restores both, the change of least kinetic energy. Splitting::between keeps none of
// the three. Neither keeps the energy, since the finer chain is another model; the caller reports the difference.
// Waves of thermal motion that only the finer chain has start cold.
//
// Bends below 180 degrees, twists within (-180, 180] degrees per bond. Units nm, ps, eV.
// Source: shape functions of the Timoshenko element, J. S. Przemieniecki, Theory of Matrix Structural Analysis
// (1968), section 5.6.
#pragma once

#include <vector>

#include "sim/state/state.hpp"

namespace ropewalk {

enum class Splitting { whole, between };

// The topology of the finer chain. Its elements have half the length, mass and inertia. A tube of n elements
// becomes one of 2 n elements (whole) or 2 n - 1 elements (between).
Topology halved(const Topology& coarse, Splitting how = Splitting::whole);

// The state on the finer chain, at the same time and step.
State halved(const Topology& coarse, const State& state, Splitting how = Splitting::whole);

// For each coarse element, the fine element that takes over its record in a force term's memory: its first half
// (whole) or the element in its place (between).
std::vector<int> heirs(const Topology& coarse, Splitting how = Splitting::whole);

}  // namespace ropewalk
