// One step on two levels (r-RESPA). The contact and its viscosity act as impulses at both ends of the step dt;
// between them lie n steps of velocity Verlet of dt/n with bonds, loads and constraints alone. Symplectic where
// nothing is damped. M. Tuckerman, B. J. Berne, G. J. Martyna, J. Chem. Phys. 97, 1990 (1992),
// DOI 10.1063/1.463137.
#pragma once

namespace ropewalk {

// `System` has kick_by_contact(dt), kick_by_bonds(dt), drift(dt), compute_bonds(dt) and compute_contact(dt); the
// last two also account for what the damping forces dissipate in dt. dt in ps.
template <class System>
void two_level_step(System system, double dt, int n) {
  const double inner = dt / n;
  system.kick_by_contact(0.5 * dt);
  system.kick_by_bonds(0.5 * inner);
  for (int k = 1; k <= n; ++k) {
    system.drift(inner);
    system.compute_bonds(inner);
    // The second half kick of one inner step and the first of the next have the same forces.
    system.kick_by_bonds(k < n ? inner : 0.5 * inner);
  }
  system.compute_contact(dt);
  system.kick_by_contact(0.5 * dt);
}

}  // namespace ropewalk
