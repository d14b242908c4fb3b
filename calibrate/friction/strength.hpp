// Static friction of two rigid tubes side by side, over registers.
//
// At a register (both turns and the shift, random) one tube slips past the other one by 1 nm, along the axis or
// around its own axis; at each place the distance is that at which the tubes neither pull nor push. The strength is
// the largest force on that way. Its growth with the length of the contact is the strength per length, what remains
// at length zero that of two ends.
#pragma once

#include <vector>

#include "atomistic/stiffness.hpp"
#include "friction/rigid_pair.hpp"

namespace ropewalk::calibrate {

enum class Slip { along, spin_a, spin_b };

inline constexpr double slip_step = 0.0125, slip_range = 1.0;  // nm

struct SlipCurve {
  std::vector<double> distance;                     // nm between the axes, at each place
  std::vector<std::vector<RegisterForces>> forces;  // at each place, of each length
};
// `pressed`: nm by which the tubes stand nearer than they would.
SlipCurve slip_curve(const RigidPair& pair, Slip slip, Register at, const std::vector<double>& lengths,
                     double pressed = 0, double step = slip_step, double range = slip_range);
double force_of(const RegisterForces& forces, Slip slip);
// Largest force of each length (eV/nm).
std::vector<double> strengths(const SlipCurve& curve, Slip slip);

// Turns of both tubes, and shifts of b within `period` (nm), by a low-discrepancy sequence.
std::vector<Register> registers(int count, double period);

// Over registers; errors are those of the mean.
struct Strength {
  Measured per_length;            // eV/nm^2
  Measured of_ends;               // eV/nm, both
  double least = 0, largest = 0;  // per length, of one register
  double spread = 0;              // standard deviation over registers
  Measured elastic_slip;          // nm: strength over steepest stiffness, of the longest contact
};
// Spins of a and b count together.
Strength along_strength(const RigidPair& pair, const std::vector<Register>& at, const std::vector<double>& lengths);
Strength spin_strength(const RigidPair& pair, const std::vector<Register>& at, const std::vector<double>& lengths);

// Mean strength of the longest contact over that of the same registers pressed together by nothing, and what
// presses (eV/nm^2).
struct Pressed {
  double nearer = 0;  // nm
  Measured ratio;
  double force = 0;
};
std::vector<Pressed> pressed_strengths(const RigidPair& pair, const std::vector<Register>& at,
                                       const std::vector<double>& nearer);

struct Crossed {
  double angle = 0;  // rad
  Measured force;    // eV/nm, of all of b
};
std::vector<Crossed> crossed_strengths(const RigidPair& pair, const std::vector<Register>& at,
                                       const std::vector<double>& angles);

Measured mean_of(const std::vector<double>& values);

}  // namespace ropewalk::calibrate
