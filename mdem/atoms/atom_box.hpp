// The box of a simulation of atoms, which may be triclinic and periodic.
#pragma once

#include <Eigen/Dense>
#include <array>
#include <cmath>

#include "model/bond.hpp"

namespace ropewalk {

struct AtomBox {
  Vector3 origin = Vector3::Zero();                      // nm
  Eigen::Matrix3d edges = Eigen::Matrix3d::Identity();   // columns, nm
  std::array<bool, 3> periodic = {false, false, false};  // along each edge
  bool periodic_known = true;                            // false: the file has a box and does not say

  Eigen::Matrix3d inverse() const { return edges.inverse(); }
  // Between the faces that an edge connects, nm.
  double width(int k) const {
    const Vector3 normal = edges.col((k + 1) % 3).cross(edges.col((k + 2) % 3));
    return std::fabs(edges.col(k).dot(normal)) / normal.norm();
  }
};

// Shortest images of differences; right for those shorter than half of each width.
class NearestImage {
 public:
  explicit NearestImage(const AtomBox& box) : box_(box), inverse_(box.inverse()) {}
  Vector3 operator()(Vector3 difference) const {
    const Vector3 parts = inverse_ * difference;
    for (int k = 0; k < 3; ++k)
      if (box_.periodic[static_cast<std::size_t>(k)]) difference -= std::round(parts[k]) * box_.edges.col(k);
    return difference;
  }

 private:
  AtomBox box_;
  Eigen::Matrix3d inverse_;
};

}  // namespace ropewalk
