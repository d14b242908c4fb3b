#include "scene/wound.hpp"

#include <Eigen/Geometry>
#include <cmath>

namespace ropewalk {

State wound(const State& straight, double turn, double rate) {
  State out = straight;
  Vector3 middle = Vector3::Zero();
  for (std::size_t i = 0; i < out.size(); ++i) middle += straight.position[i] / static_cast<double>(out.size());
  for (std::size_t i = 0; i < out.size(); ++i) {
    const Vector3 arm = Vector3(straight.position[i]) - middle;
    const Vector3 radial(arm.x(), arm.y(), 0);
    const double slope = radial.norm() * turn, height = arm.z() / std::sqrt(1 + slope * slope);
    const Quaternion about(Eigen::AngleAxisd(turn * height, Vector3::UnitZ()));
    Quaternion q = straight.orientation[i];
    if (slope != 0) q = Quaternion(Eigen::AngleAxisd(-std::atan(slope), radial.normalized())) * q;
    const Vector3 turned = about * radial, spin(0, 0, rate * height);
    out.position.set(i, middle + turned + Vector3(0, 0, height));
    out.orientation.set(i, (about * q).normalized());
    out.velocity.set(i, spin.cross(turned));
    out.angular_velocity.set(i, spin);
  }
  return out;
}

}  // namespace ropewalk
