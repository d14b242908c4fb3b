// Distance of two straight segments, such as the axes of two elements.
#pragma once

#include <algorithm>
#include <cmath>

#include "model/bond.hpp"  // Vector3

namespace ropewalk {

// Squared distance (nm^2) of x_i + a n_i, |a| <= half_i, and x_i + separation + b n_j, |b| <= half_j. For a given a
// the nearest b follows by clamping, and the other way round; where the free minimum is out of range, the nearest
// points are found by clamping one, then the other. Rounding in nearly parallel ones makes it too large by 1e-8 nm
// at most.
inline double squared_segment_distance(const Vector3& separation, const Vector3& n_i, const Vector3& n_j,
                                       double half_i, double half_j) {
  const double c = n_i.dot(n_j), p = n_i.dot(separation), q = n_j.dot(separation);
  const double sine2 = n_i.cross(n_j).squaredNorm();
  // Segments are parallel: every a that is in range of the other's middle is as good.
  const double free_a = sine2 > 1e-20 ? (p - c * q) / sine2 : p;
  double a = std::clamp(free_a, -half_i, half_i);
  const double b = std::clamp(c * a - q, -half_j, half_j);
  a = std::clamp(p + c * b, -half_i, half_i);
  return (separation + b * n_j - a * n_i).squaredNorm();
}

// A lower bound of the squared distance (nm^2), by far fewer operations; may be negative. Ahead along i's axis, and
// beside it:
//   max(|d.n_i| - ahead, 0)^2 + d^2 - (d.n_i)^2 - beside |d.n_j - (d.n_i)(n_i.n_j)|
// with d the separation, ahead = half_i + half_j and beside = 2 half_j.
inline double min_squared_distance(const Vector3& separation, const Vector3& n_i, const Vector3& n_j, double ahead,
                                   double beside) {
  const double along = separation.dot(n_i), from = std::max(std::fabs(along) - ahead, 0.0);
  const double tilted = separation.dot(n_j) - along * n_i.dot(n_j);
  return from * from + separation.squaredNorm() - along * along - beside * std::fabs(tilted);
}

}  // namespace ropewalk
