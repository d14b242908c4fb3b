// Whether the forces of a scene follow from its energy, for whoever writes a law or a force term:
//
//     E(x + h d) - E(x - h d) = -2 h F . d
//
// to second order in h, where x is the start of the scene with all elements shaken, at rest, and d a random motion
// and turn of every element. Loads have no part in it, and memories of terms stay as they are.
#pragma once

#include "sim/dynamics/simulation.hpp"

namespace ropewalk {

struct EnergyCheck {
  double by_forces = 0, by_energy = 0;  // energy for a motion of 1 nm, eV
  double size = 0;                      // sum of the elements' parts without their signs, eV
  // Relative to that size.
  double error() const;
};
EnergyCheck energy_check(const Simulation& simulation);

}  // namespace ropewalk
