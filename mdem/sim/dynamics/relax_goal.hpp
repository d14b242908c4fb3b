// What a relaxation has to reach, and what it came to.
#pragma once

#include <limits>

namespace ropewalk {

// It ends where both hold.
struct RelaxGoal {
  double force = 1e-4;   // eV/nm: of the largest force, and of the largest torque over the radius of its tube
  double energy = 1e-3;  // of the bonds' energy: its error, by estimate
};

// How a relaxation ended. The energy is a parabola near its minimum, F.K^-1.F/2 above it with forces F and
// stiffness K. Under loads F0 the bonds' energy U = F0.K^-1.F0/2 is off by F0.K^-1.F at most, that is by 2 sqrt(U
// above).
struct Relaxed {
  bool at_rest = false;
  double force = 0;  // eV/nm, the largest
  // eV above the minimum; infinite: none is near, the energy falls along some motion; NaN: the forces are too large
  double above = std::numeric_limits<double>::quiet_NaN();
  double error = std::numeric_limits<double>::quiet_NaN();  // 2 sqrt(above/U)
};

}  // namespace ropewalk
