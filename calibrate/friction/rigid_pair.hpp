// Two rigid tubes side by side, atom by atom: the forces against sliding and spinning at any register.
//
// Tube a lies on the z axis, tube b beside it on x = distance. E is the sum of the Lennard-Jones law over the pairs
// of atoms of both, and
//
//   along = -dE/dz of b,   spin_b = -(dE/d turn of b)/r_b,   spin_a = -(dE/d turn of a)/r_a
//
// are forces (eV/nm). spin_a and spin_b act on the surface of a tube that turns. Units nm, eV.
#pragma once

#include <vector>

#include "contact/van_der_waals.hpp"

namespace ropewalk::calibrate {

struct Register {
  double turn_a = 0, turn_b = 0;  // rad, about the axes
  double shift = 0;               // shift of b along the axis, nm
  double tilt = 0;                // turn of b about the line between the axes, rad
};

struct RegisterForces {
  double energy = 0;  // eV
  double apart = 0;   // -dE/d distance, eV/nm
  double along = 0;   // eV/nm
  double spin_a = 0, spin_b = 0;
};

class RigidPair {
 public:
  // Atoms (nm) about the z axis; b is the shorter one.
  RigidPair(const AtomLaw& law, std::vector<Vector3> a, double radius_a, std::vector<Vector3> b, double radius_b);

  // The forces on parts of b. Each part begins at the lower end of b; `lengths` (nm) rise, and the last part is b.
  std::vector<RegisterForces> forces(const Register& at, double distance, const std::vector<double>& lengths) const;

  // The distance (nm) near `start` at which all of b is neither pulled nor pushed.
  double free_distance(const Register& at, double start) const;

  double length() const { return length_; }  // length of b, nm
  double radius_a() const { return radius_a_; }
  double radius_b() const { return radius_b_; }

 private:
  AtomLaw law_;
  std::vector<Vector3> a_, b_;  // ascending in z
  double radius_a_, radius_b_, length_ = 0, low_ = 0;
};

}  // namespace ropewalk::calibrate
