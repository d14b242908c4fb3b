#include "sim/neighbours/motion_since.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace ropewalk {

// The axis of the twist passes through the mean position. The bounds hold for any other axis too.
void MotionSince::start(Vec3Array position, Vec3Array axis) {
  position_ = std::move(position);
  axis_ = std::move(axis);
  const Vec3Array& p = position_;
  twist_ = {};
  farthest_ = 0;
  for (double& sum : arms2_) sum = 0;
  const double n = static_cast<double>(p.size());
  for (std::size_t i = 0; i < p.size(); ++i) {
    twist_.x += p.x[i] / n;
    twist_.y += p.y[i] / n;
    twist_.middle += p.z[i] / n;
  }
  for (std::size_t i = 0; i < p.size(); ++i) {
    const double x = p.x[i] - twist_.x, y = p.y[i] - twist_.y, z = p.z[i] - twist_.middle, arm2 = x * x + y * y;
    farthest_ = std::max(farthest_, std::sqrt(arm2));
    arms2_[0] += arm2;
    arms2_[1] += z * arm2;
    arms2_[2] += z * z * arm2;
  }
}

Change MotionSince::change(const State& state, double lever, std::ptrdiff_t begin, std::ptrdiff_t end) const {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Change c;
  if (position_.size() == state.size()) c = largest_change(state, position_, axis_, lever, twist_, begin, end);
  if (position_.size() != state.size() || !std::isfinite(c.sum)) c.moved = infinity;
  return c;
}

// A common twist changes the distance of two points by no more than their relative rotation times their distance
// from the axis.
double MotionSince::bound(const Change& all, double within, double lever) {
  const double against = 1.01 * std::fabs(twist_.slope) * within;
  const double moved = all.moved + 0.5 * against * (farthest_ + lever);
  if (std::isfinite(moved)) follow(all);
  return moved;
}

void MotionSince::follow(const Change& change) {
  const double determinant = arms2_[0] * arms2_[2] - arms2_[1] * arms2_[1];
  constexpr double fewest = 0.01;  // nm^2, mean squared distance from the axis: less in a single tube along z
  if (!(arms2_[0] > fewest * static_cast<double>(position_.size())) ||
      !(determinant > 1e-6 * arms2_[0] * arms2_[2]))
    return;
  twist_.sine = (change.spin * arms2_[2] - change.spin_z * arms2_[1]) / determinant;
  twist_.slope = (change.spin_z * arms2_[0] - change.spin * arms2_[1]) / determinant;
}

}  // namespace ropewalk
