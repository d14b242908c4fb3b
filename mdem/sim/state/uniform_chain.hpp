// Energy of a chain that is evenly stretched, twisted and bent: what its bonds make of a rod.
#pragma once

#include <cmath>

#include "sim/state/state.hpp"

namespace ropewalk {

// Per length (eV/nm) of a chain of equal bonds; `element` is their length (nm). Strain of the chord, twist (rad/nm)
// and curvature (1/nm) against the natural ones; EI is the mean of two.
inline double chain_energy(const BondStiffness& bond, double element, double strain, double twist,
                           double curvature) {
  const Frame i = frame_of(Quaternion::Identity());
  const double turn = curvature * element;
  const Quaternion bent(Eigen::AngleAxisd(turn, Vector3::UnitY()));
  const Frame j = frame_of(bent * Quaternion(Eigen::AngleAxisd(twist * element, Vector3::UnitZ())));
  const Vector3 chord(std::sin(0.5 * turn), 0, std::cos(0.5 * turn));
  return bond_energy(straightened(bond), element, element * (1 + strain) * chord, i, j).total() / element;
}

}  // namespace ropewalk
