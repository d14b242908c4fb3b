// The moments that a bond carries.
#pragma once

#include <algorithm>
#include <cmath>

#include "model/bond.hpp"

namespace ropewalk {

// The derivative of the energy by the angle between the axes (eV): EI times the change of curvature where that is small.
// Bonds that are together so long; i and j: the frames at their ends.
inline double bending_moment(const BondStiffness& k, double length, const Frame& i, const Frame& j) {
  const BondEnds ends = bond_ends(k, length, i, j);
  const double curvature = 2.0 * std::asin(std::min(0.5 * (ends.i.t - ends.j.t).norm(), 1.0)) / length;
  if (k.bend_difference != 0) {
    const double w1 = ends.i.t.dot(ends.j.e2) - ends.i.e2.dot(ends.j.t),
                 w2 = ends.i.e1.dot(ends.j.t) - ends.i.t.dot(ends.j.e1), w = std::hypot(w1, w2);
    return w > 0 ? curvature / w * std::hypot((k.bend + k.bend_difference) * w1, (k.bend - k.bend_difference) * w2) : 0;
  }
  if (!k.anharmonic.used) return k.bend * curvature;
  return 2 * bend_energy(k.anharmonic, k.bend, curvature * curvature).by_curvature2 * curvature;
}

// The largest torque (eV) of twist: where a bond of this length slips, or beyond the collapse of an anharmonic one.
inline double largest_torque(const BondStiffness& k, double length) {
  const double slip = k.twist / length;
  if (!k.anharmonic.used) return slip;
  return std::min(slip, twist_energy(k.anharmonic, k.twist, k.anharmonic.max_shear / k.anharmonic.radius).by_twist);
}

}  // namespace ropewalk
