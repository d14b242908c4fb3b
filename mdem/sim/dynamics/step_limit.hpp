// How large a time step may be.
#pragma once

#include <vector>

#include "sim/state/interaction.hpp"
#include "sim/state/state.hpp"

namespace ropewalk {

// Stability limit of the time step (ps) of endless tubes in hexagonal packing: the step dt at which some plane
// wave, of wave vector k across the tubes and q along them, has an eigenvalue of
//   M^-1/2 (K dt^2 + 2 C dt) M^-1/2
// that reaches 4. K: bonds and contact, C: damping of the bonds and viscosity of the contact, M: masses and
// inertias, all of one element, 6 x 6. Exact for velocity Verlet without damping; with damping, which acts by the
// velocities of half a step ago, a lower bound that is reached where a mode of K is one of C. The contact is as
// stiff as where the tubes are pressed to 98.5 % of their spacing. For (10,10) that takes 1.7 GPa, where bundles of
// such tubes collapse and rigid cross-sections end (J. A. Elliott et al., Phys. Rev. Lett. 92, 095501 (2004),
// DOI 10.1103/PhysRevLett.92.095501); at rest the stiffness is 0.3 of it.
struct TimeStepLimit {
  double limit = 0;  // ps
  // Its causes, each on its own: the stiffest mode, the fastest damping.
  double chain_frequency = 0;    // rad/ps
  double contact_frequency = 0;  // rad/ps
  double damping_rate = 0;       // 1/ps
  // For each plane wave: w^2 (rad^2/ps^2) of its stiffest mode, by tube type, and the six rates of damping (1/ps).
  std::vector<std::vector<double>> stiffest;
  std::vector<double> damping_rates;
};
// `spacing` of the tubes in nm; 0: a single tube.
TimeStepLimit time_step_limit(const Topology& topology, const Interaction& interaction, double spacing);

// How much hotter positions are than velocities, relative, in a scene with heat. A harmonic mode w in velocity
// Verlet with the step h keeps v^2/2 + w^2 x^2/2 (1 - (w h)^2/4), and BAOAB keeps the same ratio, so that
//   w^2 <x^2>/<v^2> = 1/(1 - (w h)^2/4).
// The mean over all waves, of the stiffest mode of each and of the tube type with the largest: stretch, shear, bend
// and twist are no hotter.
double excess_of_positions(const TimeStepLimit& limit, double step);
// The step (ps) at which that is `excess`.
double step_of_excess(const TimeStepLimit& limit, double excess);

// Part of the kinetic energy of an even distribution over all waves that damping has not taken after `time` (ps):
// mean of exp(-c t) over the rates c of damping, to each of which force terms add `of_terms` (1/ps). An estimate,
// since it leaves out what damping makes of the modes.
double heat_left(const TimeStepLimit& limit, double time, double of_terms = 0);
// Temperature over that of a Langevin bath whose friction is `coupling` (1/ps), under the same damping: a mode
// feels the noise of the bath and both frictions, so mean of coupling/(coupling + c). An estimate likewise.
double bath_held(const TimeStepLimit& limit, double coupling, double of_terms = 0);

}  // namespace ropewalk
