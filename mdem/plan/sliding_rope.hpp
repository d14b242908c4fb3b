// When a twisted rope becomes a helix, by theory: the moment at which it may, the rate at which it does, and the
// moment at which it has within the time of its loading. No number in it is fitted.
//
// N straight tubes that slide on one another bend as one rod with the bending stiffness B = EI and the mass m per
// length of a single tube. Each has a couple M at both ends, whose direction z is fixed in space. With the
// deflection u = x + iy along s (0 to L), small slopes and free ends,
//
//   m u_tt + (B u'' - i M u')'' + f_slip = 0,    B u'' - i M u' = 0 and (B u'' - i M u')' = 0 at both ends.
//
// Statics. q = B u'' - i M u' obeys m q_tt + B q'''' - i M q''' = 0 with q = q' = 0 at the ends if nothing slips:
// the equation of a clamped rod, which is self-adjoint. So rates are real, and growth begins where tan x = x with
// x = ML/2B = 4.4934: M = 8.987 B/L. Ends that are held on the axis and may tilt bear less, 2 pi B/L.
//
// Slip. In a rope that is wound by w per length, neighbours at the distance d shift along one another by the part
// of a(s) = int_0^s exp(-i w s') u''(s') ds' along the line between them, less its mean over the rope, since a tube
// moves along itself until no force is left on it. Contact viscosity takes C |a_t - mean|^2 per length of each tube
// from the motion:
//
//   C = eta/(a N) sum over pairs of tubes, sum over k, weight((d^2 + k^2 a^2)^1/2) d^2/2
//
// with elements of the length a side by side (eta, weight: model/damping.hpp). Tilting as a whole slips nothing.
//
// Winding. w = f M/B, and f is not a result of this theory: tubes that are helices free of contact forces have
// f = 1; ropes that stay packed wind less.
//
// Solved by Legendre polynomials (Galerkin), eigenvalues of exp(rate t). Units nm, ps, eV.
#pragma once

#include <optional>

#include "scene/prepare.hpp"

namespace ropewalk {

struct SlidingRope {
  double length = 0;  // nm
  double bend = 0;    // B of one tube, eV nm
  double mass = 0;    // m of one tube, eV ps^2/nm^3
  double slip = 0;    // C of one tube, eV ps/nm

  // Moment of each tube where growth begins, eV.
  double static_moment() const;
  // 1/ps: the rate of the fastest growing motion under this moment on each tube (eV) and the winding f; 0: none
  // grows.
  double growth(double moment, double winding) const;
  // Turns of the helix that this motion makes, as the observable `windings` counts them; 0: none grows.
  double windings(double moment, double winding) const;
  // The integral of growth() over time, which is the logarithm of amplitude over first amplitude. The moment rises
  // from zero at `rate` (eV/ps; 0: at once) and is then held for `hold` (ps).
  double gain(double moment, double winding, double rate, double hold) const;
  // The moment (eV) at which gain() is `wanted`.
  double moment_of_gain(double wanted, double winding, double rate, double hold) const;
};

// The theory of the helix for a scene whose ends are loaded by couples.
struct HelixTheory {
  SlidingRope rope;
  double tubes_in_unit = 1;       // the moment of the scene over that of one tube
  double static_moment = 0;       // moment in the reading of the scene, eV: ends that are free, or held on the axis
  double glued_over_sliding = 1;  // stiffness of a rope of glued tubes over that of all tubes: 1 + EA <rho^2>/2 EI
  bool grows = false;             // whether rates and times below are known
  double rate = 0, hold = 0;      // load of one tube: its rate, eV/ps, and how long it is held, ps
  double first_amplitude = 0;     // nm; 0: not known

  // In the reading of the scene (eV), that whose amplitude passes `amplitude` (nm); 0: it is not known.
  double moment_to_pass(double amplitude, double winding) const;
  // 1/ps under a moment in the reading of the scene.
  double growth(double moment, double winding) const;
  // Turns of the helix that grows under it; 0: none grows.
  double windings(double moment, double winding) const;
  // f, of a rope that turns by `turn` (rad) from end to end.
  double winding_of(double turn, double moment) const;
};
// None for scenes that are no straight rope of like tubes, or whose ends have more or less than opposite couples on
// each tube. Rates are known where the ends are free and what damps is the viscosity of the contacts. The first
// amplitude is half of [start] wave_nm: a plane wave is the sum of two helices of opposite hand, one of which
// grows.
std::optional<HelixTheory> helix_theory(const Scene& scene, const Prepared& prepared);

}  // namespace ropewalk
