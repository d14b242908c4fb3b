// The moments that a bond carries.
#pragma once

#include <algorithm>
#include <cmath>

#include "model/bond.hpp"

namespace ropewalk {

// The derivative of the energy by the angle between the axes (eV): EI times the curvature where that is small.
inline double bending_moment(const BondStiffness& k, double length, const Vector3& axis_i, const Vector3& axis_j) {
  const double curvature = 2.0 * std::asin(std::min(0.5 * (axis_i - axis_j).norm(), 1.0)) / length;
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
