// What moves in a mode (sim/dynamics/modes.hpp): the parts of its kinetic energy, and the form of the centre line.
#pragma once

#include "sim/dynamics/modes.hpp"

namespace ropewalk {

// Parts of the kinetic energy; their sum is one. The first three are of a cross-section as a whole, which is made
// of the elements of equal number; where tubes have no common length each element is one.
struct ModeShares {
  double sideways = 0;  // across the centre line
  double stretch = 0;   // along it
  double turn = 0;      // about it
  double slip = 0;      // sliding of tubes along themselves, within a cross-section
  double section = 0;   // what else changes the cross-section
  double spin = 0;      // turns of elements about their own axes
  double tilt = 0;      // and about others
};

struct ModeShape {
  ModeShares shares;
  // Sideways motion of the centre line: its turns about the chord (helix_of()), and its half waves in the
  // plane in which it moves most; NaN where nothing moves sideways.
  double windings = 0, half_waves = 0;

  // The largest share by name.
  const char* name() const;
};

ModeShape shape_of(const Topology& topology, const State& state, const Eigen::VectorXd& mass, const Mode& mode);

}  // namespace ropewalk
