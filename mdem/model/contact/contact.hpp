// The result of every contact law between two rigid tube elements: exact gradients of one energy, so that
// force_i = -force_j and torque_i + torque_j + separation x force_j = 0.
#pragma once

#include <algorithm>
#include <cmath>

#include "model/bond.hpp"  // Vector3

namespace ropewalk {

// Energy and force of a pair: on element j, and the torques about the two centres. Element i feels -force_j.
struct PairForce {
  double energy = 0;
  Vector3 force_j = Vector3::Zero();
  Vector3 torque_i = Vector3::Zero();
  Vector3 torque_j = Vector3::Zero();
};

namespace detail {

inline double safe_distance(const Vector3& s) { return std::sqrt(std::max(s.squaredNorm(), 1e-12)); }

}  // namespace detail

}  // namespace ropewalk
