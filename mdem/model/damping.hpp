// Dissipation. No damping constant of nanotube ropes has been published, so all of them are parameters, and
// zero switches a term off. The first two conserve linear and angular momentum exactly: pairwise opposite
// forces at one common point, and nothing at all for a rigid motion of the whole.
//
//   contact viscosity  F_j = -eta w(R) [v_j + w_j x (p - x_j) - v_i - w_i x (p - x_i)] at the contact point
//                      p = (x_i + x_j)/2; w falls from 1 to 0 between the equilibrium spacing and 1.5 of it.
//                      Without the lever arms a rigidly spinning rope would be braked.
//   bond damping       the same at the middle of a bond, with F_j = -lambda m/2 v_rel and a relative
//                      rotation damped by the couple -lambda I/2 (w_j - w_i); lambda in 1/ps.
//   PFC local          F -> F - alpha |F| sign(v), component by component, of the total force and torque
//                      (P. A. Cundall, in Eng. Rock Mech. Comput. Methods (1987)). Depends on the frame and
//                      breaks momentum conservation: for comparison with PFC3D only.
//
// Units: eta eV ps/nm^2, lambda 1/ps, alpha without unit.
#pragma once

#include <algorithm>
#include <cmath>

#include "model/bond.hpp"  // Vector3

namespace ropewalk {

// Opposite forces at one point, as seen at the two centres.
struct DampingForce {
  Vector3 force_j;
  Vector3 torque_i, torque_j;
  double power = 0;  // work per time done on the pair, never positive (eV/ps)
};

struct ContactViscosity {
  double eta = 0;    // eV ps/nm^2
  double inner = 0;  // nm: full strength up to here
  double outer = 0;  // nm: nothing from here on

  double weight(double distance) const {
    const double y = std::min(std::max((distance - inner) / (outer - inner), 0.0), 1.0);
    return 1.0 - y * y * (3.0 - 2.0 * y);
  }

  // separation = x_j - x_i, velocities and angular velocities of the two elements.
  DampingForce force(const Vector3& separation, const Vector3& v_i, const Vector3& w_i, const Vector3& v_j,
                     const Vector3& w_j) const {
    const Vector3 arm = 0.5 * separation;  // from x_i to p; from x_j to p it is -arm
    const Vector3 relative = v_j - v_i - (w_i + w_j).cross(arm);
    DampingForce f;
    f.force_j = -eta * weight(separation.norm()) * relative;
    f.torque_i = -arm.cross(f.force_j);
    f.torque_j = f.torque_i;
    f.power = f.force_j.dot(relative);
    return f;
  }
};

struct BondDamping {
  double rate = 0;  // lambda, 1/ps

  // Entries, over the masses, of the damping matrix of an infinite chain for deflections u and rotations phi of
  // wave number q (1/element); the coupling is made symmetric by the masses.
  struct Mode {
    double uu = 0, pp = 0, up = 0;
  };
  Mode mode(double q, double a, double mass, double inertia) const {
    return {rate * (1 - std::cos(q)), rate * (1 - std::cos(q) + 0.25 * mass * a * a / inertia * (1 + std::cos(q))),
            0.5 * rate * a * std::sin(q) * std::sqrt(mass / inertia)};
  }
  // Rate of the strongest damped motion of such a chain, 1/ps: opposite motions of neighbours, or all turning alike
  // against their lever arms.
  double largest_rate(double a, double mass, double inertia) const {
    double largest = 0;
    for (int step = 0; step <= 256; ++step) {
      const Mode d = mode(units::pi * step / 256.0, a, mass, inertia);
      largest =
          std::fmax(largest, 0.5 * (d.uu + d.pp) + std::sqrt(0.25 * (d.uu - d.pp) * (d.uu - d.pp) + d.up * d.up));
    }
    return largest;
  }

  DampingForce force(double mass, double inertia, const Vector3& separation, const Vector3& v_i, const Vector3& w_i,
                     const Vector3& v_j, const Vector3& w_j) const {
    const forms::PairDamping f =
        forms::bond_damping(rate, mass, inertia, plain(separation), plain(v_i), plain(w_i), plain(v_j), plain(w_j));
    return {vector(f.force_j), vector(f.torque_i), vector(f.torque_j), f.power};
  }
};

// The PFC local damping of one component.
inline double pfc_local(double alpha, double force, double velocity) {
  const double sign = velocity > 0 ? 1.0 : velocity < 0 ? -1.0 : 0.0;
  return -alpha * std::fabs(force) * sign;
}

struct Damping {
  ContactViscosity contact;
  BondDamping bond;
  double local = 0;  // PFC alpha
};

}  // namespace ropewalk
