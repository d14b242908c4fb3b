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
//
// Both Simulation and the ranks of LAMMPS step by these functions. dt in ps, energies in eV. Their `System` has
//
//   account()              what it keeps of energy
//   kick(dt)               velocities by the forces, then the constraints, with the account of both
//   add_work_of_loads(dt)  to the account, at the velocities of now
//   drift(dt)              places, turns and time
//   bathe(dt)              the bath, then the constraints; kinetic_energy(): of all or of its own elements
//   damped(dt)             what damping and memories have taken out since the last step
#pragma once

#include "sim/dynamics/energy_supply.hpp"

namespace ropewalk {

// The work of the loads is exact: the mean power before and after the kick, times dt.
template <class System>
void kick_with_loads(System& system, double dt) {
  system.add_work_of_loads(0.5 * dt);
  system.kick(dt);
  system.add_work_of_loads(0.5 * dt);
}

// Goes from the forces of the last step to the positions at which new ones are needed.
template <class System>
void begin_step(System& system, double dt, bool thermostat) {
  kick_with_loads(system, 0.5 * dt);
  if (!thermostat) return system.drift(dt);
  system.drift(0.5 * dt);
  const double before = system.kinetic_energy();
  system.bathe(dt);
  system.account().heat += system.kinetic_energy() - before;
  system.drift(0.5 * dt);
}

template <class System>
void end_step(System& system, double dt) {
  system.account().dissipated += system.damped(dt);
  kick_with_loads(system, 0.5 * dt);
}

}  // namespace ropewalk
