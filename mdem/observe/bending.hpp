// The bending moment that a bond carries.
#pragma once

#include <algorithm>
#include <cmath>

#include "model/bond.hpp"

namespace ropewalk {

// EI times the angle between the axes over the length (eV).
inline double bending_moment(const BondStiffness& k, double length, const Vector3& axis_i, const Vector3& axis_j) {
  return k.bend / length * 2.0 * std::asin(std::min(0.5 * (axis_i - axis_j).norm(), 1.0));
}

}  // namespace ropewalk
