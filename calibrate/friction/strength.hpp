// Static friction of two rigid tubes side by side, over registers.
//
// A register is a pair of turns and a shift. From each register one tube slips past the other one by 1 nm, along
// the axis or around its own axis. At each place the tubes have the distance at which they neither attract nor
// repel. The strength is the largest force on the way. The strength grows with the length of the contact: its slope
// is the strength per length, and the line meets length zero at the strength of two ends.
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
// `pressed` (nm) is subtracted from the distance at which the tubes neither attract nor repel.
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
// The strength against spin is the mean of that of a and that of b.
Strength along_strength(const RigidPair& pair, const std::vector<Register>& at, const std::vector<double>& lengths);
Strength spin_strength(const RigidPair& pair, const std::vector<Register>& at, const std::vector<double>& lengths);

// Strength of the longest contact where the tubes are pressed together.
struct Pressed {
  double nearer = 0;  // nm, less than the distance at which they neither attract nor repel
  Measured ratio;     // strength over that of free tubes
  double force = 0;   // mean force that presses, eV/nm^2
};
std::vector<Pressed> pressed_strengths(const RigidPair& pair, const std::vector<Register>& at,
                                       const std::vector<double>& nearer);

struct Crossed {
  double angle = 0;  // rad
  Measured force;    // force on all of b, eV/nm
};
std::vector<Crossed> crossed_strengths(const RigidPair& pair, const std::vector<Register>& at,
                                       const std::vector<double>& angles);

Measured mean_of(const std::vector<double>& values);

}  // namespace ropewalk::calibrate
