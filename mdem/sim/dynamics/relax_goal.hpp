// The goal of a relaxation, its result, and where it stands.
#pragma once

#include <cstdint>
#include <limits>

#include "sim/dynamics/fire.hpp"

namespace ropewalk {

// It ends where both hold.
struct RelaxGoal {
  double force = 1e-4;   // eV/nm: of the largest force, and of the largest torque over the radius of its tube
  double energy = 1e-3;  // estimated error over the bonds' energy

  bool operator==(const RelaxGoal& o) const { return force == o.force && energy == o.energy; }
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
  std::int64_t saddles = 0;                                 // that it rested on and left
  // Where it rests on a saddle and stayed there: how far the energy falls beyond it at least, eV; else 0.
  double falls = 0;
};

// Where Newton's method stands between two of its steps (sim/statics/newton.hpp).
struct NewtonPace {
  bool newton = false;       // false: the relaxation goes by FIRE
  double rate = 0;           // 1/ps: the shift is its square; 0: it has yet to begin
  double falling = 0;        // 1/ps: of a motion that was found to fall; 0: none is known
  std::int64_t saddles = 0;  // that were left
  double saddle_energy = 0;  // eV, potential less the work of the loads, of the last one
};

// The state of a relaxation between two of its steps. It has parts: if the forces are small and the energy is
// not, the next part goes on to smaller forces. If both are small, and yet the energy falls along some motion,
// the state is moved along it, and the next part goes on from there.
struct Relaxation {
  std::int64_t began = -1;  // step; negative: none is underway
  RelaxGoal goal;
  double first_energy = 0;       // eV, potential less the work of the loads
  std::int64_t part_began = -1;  // step; negative: the next part has yet to begin
  double force = 0;              // eV/nm, that the part has to reach
  double constant = 0;           // eV, energy less supplied energy
  double longest_bond = 0;       // of an element's length; a longer one is torn
  double last_step = 0;          // ps
  std::int64_t disturbances = 0;
  double disturbed_from = 0;  // eV, potential less the work of the loads, before the last one
  Fire fire{0};
  NewtonPace newton;

  bool underway() const { return began >= 0; }
};

// The step at which the last relaxation came to rest, with its Relaxed::saddles and Relaxed::falls. A relaxation
// that begins at this step tries no motion again. So a run that was killed after the end of its relaxation is
// resumed to the same bits.
struct Rest {
  std::int64_t step = -1;
  std::int64_t saddles = 0;
  double falls = 0;
};

}  // namespace ropewalk
