// One step of velocity Verlet for positions x and orientations q, as kick, drift and kick:
//
//   v += F dt/2m,  w += M dt/2I;   x += v dt,  q <- exp(w dt) q;   F and M of the new state;   v += .., w += ..
//
// The inertia is isotropic, so w is constant between kicks and the rotation is exact. The scheme is symplectic,
// time reversible and of second order. Damping forces are those of the velocities at half the step.
//
// A thermostat acts in the middle of the drift (BAOAB). For harmonic forces the positions then have the exact
// canonical distribution at every stable step, and so have the velocities at half the step; at its end <v^2> is too
// low by the factor 1 - (w dt)^2/4 in a mode of the angular frequency w. B. Leimkuhler, C. Matthews, Appl. Math.
// Res. Express 2013, 34, DOI 10.1093/amrx/abs010. Z. Zhang et al., J. Chem. Phys. 147, 034109 (2017),
// DOI 10.1063/1.4991621.
#pragma once

namespace ropewalk {

// `System` has kick(dt), drift(dt), exchange_heat(dt) and compute_forces(). dt in ps.
template <class System>
void verlet_step(System system, double dt, bool thermostat) {
  system.kick(0.5 * dt);
  if (thermostat) {
    system.drift(0.5 * dt);
    system.exchange_heat(dt);
    system.drift(0.5 * dt);
  } else {
    system.drift(dt);
  }
  system.compute_forces();
  system.kick(0.5 * dt);
}

}  // namespace ropewalk
