// Two tubes side by side with all their atoms free but a strip of each, on the side that is turned away, in LAMMPS.
// The strip of a stands still. That of b is rigid, is led along the axis or around b, and finds its distance by
// itself.
//
//   at 0 K    energies of minimised atoms at each place: what relaxation adds to the friction of rigid tubes
//   at 300 K  the mean force that it takes to lead b along at a constant speed: drag
#pragma once

#include <string>
#include <vector>

#include "atoms/lammps.hpp"
#include "atoms/lattice.hpp"
#include "atoms/potential.hpp"
#include "friction/strength.hpp"

namespace ropewalk::calibrate {

struct SlidingTubes {
  Potential potential;
  AtomLaw law;  // with a finite cutoff
  std::vector<Vector3> a, b;
  double radius_a = 0, radius_b = 0;  // nm
};

// Throws InputError where the potential's lines are not of one known form, which two tubes need.
std::string pair_commands(const Potential& potential, const AtomLaw& law);

// Largest difference of energy over a step (eV/nm) on a way of 0.5 nm, Slip::along or spin_b; and the same of rigid
// tubes.
struct RelaxedStrength {
  double relaxed = 0, rigid = 0;
};
RelaxedStrength relaxed_strength(const SlidingTubes& tubes, const Register& at, Slip slip,
                                 const std::string& folder, const std::string& name, const LammpsOptions& options);

// The mean of a force that also has the corrugation's period along its way `s` (nm), of samples every 0.1 ps.
// Blocks of 1 ps say how many of them are independent.
Measured mean_without_period(const std::vector<double>& force, const std::vector<double>& s, double period);

struct Drag {
  std::vector<double> speeds;   // nm/ps
  std::vector<Measured> force;  // eV/nm^2, per length
  Measured drag;                // eV ps/nm^3
};
// `duration` (ps) at each speed; `period` (nm): that of the corrugation, which the mean leaves out.
Drag measured_drag(const SlidingTubes& tubes, const Register& at, double duration, double period,
                   const std::string& folder, const std::string& name, const LammpsOptions& options);

}  // namespace ropewalk::calibrate
