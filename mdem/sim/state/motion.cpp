#include "sim/state/motion.hpp"

#include <algorithm>
#include <cmath>

#include "model/contract.hpp"
#include "sim/threads/vector_unit.hpp"

#define ROPEWALK_LOOPS "sim/state/motion_loops-inl.hpp"
#include "sim/threads/for_each_vector_unit-inl.hpp"

namespace ropewalk {

void kick_elements(const Vec3Array& force, double by, Vec3Array& velocity, std::ptrdiff_t begin,
                   std::ptrdiff_t end) {
  ROPEWALK_EXPECTS(begin >= 0 && begin <= end &&
                   static_cast<std::size_t>(end) <= std::min(force.size(), velocity.size()));
  ROPEWALK_IN_USE(kick_elements)(force, by, velocity, begin, end);
}

void move_elements(State& s, double dt, std::ptrdiff_t begin, std::ptrdiff_t end) {
  ROPEWALK_EXPECTS(begin >= 0 && begin <= end && static_cast<std::size_t>(end) <= s.size());
  ROPEWALK_IN_USE(move_elements)(s, dt, begin, end);
}

void move_elements_runge_kutta(State& s, double dt, std::ptrdiff_t begin, std::ptrdiff_t end) {
  for (std::ptrdiff_t k = begin; k < end; ++k) {
    const auto i = static_cast<std::size_t>(k);
    s.position.add(i, dt * s.velocity[i]);
    const Vector3 w = s.angular_velocity[i];
    const auto slope = [&](const Eigen::Vector4d& q) {  // w, x, y, z
      const Vector3 v = q.tail<3>();
      Eigen::Vector4d out;
      out[0] = -0.5 * w.dot(v);
      out.tail<3>() = 0.5 * (q[0] * w + w.cross(v));
      return out;
    };
    const Eigen::Vector4d q(s.orientation.w[i], s.orientation.x[i], s.orientation.y[i], s.orientation.z[i]);
    const Eigen::Vector4d k1 = slope(q), k2 = slope(q + 0.5 * dt * k1), k3 = slope(q + 0.5 * dt * k2),
                          k4 = slope(q + dt * k3);
    const Eigen::Vector4d next = (q + dt / 6 * (k1 + 2 * k2 + 2 * k3 + k4)).normalized();
    s.orientation.set(i, Quaternion(next[0], next[1], next[2], next[3]));
  }
}

Fastest fastest(const State& s, std::ptrdiff_t begin, std::ptrdiff_t end) {
  return ROPEWALK_IN_USE(fastest)(s, begin, end);
}

Change largest_change(const State& state, const Vec3Array& position, const Vec3Array& axis, double lever,
                      const TwistOfAll& twist, std::ptrdiff_t begin, std::ptrdiff_t end) {
  ROPEWALK_EXPECTS(position.size() == state.size() && axis.size() == state.size());
  return ROPEWALK_IN_USE(largest_change)(state, position, axis, lever, twist, begin, end);
}

}  // namespace ropewalk
