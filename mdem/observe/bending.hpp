// The bending moment that a bond carries.
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

}  // namespace ropewalk
