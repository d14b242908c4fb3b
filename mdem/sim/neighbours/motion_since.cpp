#include "sim/neighbours/motion_since.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "model/contract.hpp"

namespace ropewalk {

// The axis of the twist passes through the mean position. The bounds hold for any other axis too.
void MotionSince::start(const Topology& topology, Vec3Array position, Vec3Array axis, const AllProcesses* others) {
  ROPEWALK_EXPECTS(position.size() == axis.size() && static_cast<int>(position.size()) == topology.elements());
  position_ = std::move(position);
  axis_ = std::move(axis);
  others_ = others;
  const Vec3Array& p = position_;
  const auto each = [&](const auto& work) {
    for (int i = 0; i < topology.elements(); ++i)
      if (topology.owns(i)) work(static_cast<std::size_t>(i));
  };
  double none = 0, count[3] = {0, 0, 0}, mean[3] = {0, 0, 0};
  each([&](std::size_t) { count[0] += 1; });
  if (others_) others_->join(none, count);
  const double n = count[0];
  each([&](std::size_t i) { mean[0] += p.x[i] / n, mean[1] += p.y[i] / n, mean[2] += p.z[i] / n; });
  if (others_) others_->join(none, mean);
  elements_ = n;
  twist_ = {};
  twist_.x = mean[0], twist_.y = mean[1], twist_.middle = mean[2];
  farthest_ = 0;
  for (double& sum : arms2_) sum = 0;
  each([&](std::size_t i) {
    const double x = p.x[i] - twist_.x, y = p.y[i] - twist_.y, z = p.z[i] - twist_.middle, arm2 = x * x + y * y;
    farthest_ = std::max(farthest_, std::sqrt(arm2));
    arms2_[0] += arm2;
    arms2_[1] += z * arm2;
    arms2_[2] += z * z * arm2;
  });
  if (others_) others_->join(farthest_, arms2_);
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
double MotionSince::bound(Change all, double within, double lever) {
  ROPEWALK_EXPECTS(within >= 0 && lever >= 0);
  if (others_) {
    double sums[3] = {all.sum, all.spin, all.spin_z};
    others_->join(all.moved, sums);
    all.sum = sums[0], all.spin = sums[1], all.spin_z = sums[2];
  }
  const double against = 1.01 * std::fabs(twist_.slope) * within;
  const double moved = all.moved + 0.5 * against * (farthest_ + lever);
  if (std::isfinite(moved)) follow(all);
  return moved;
}

void MotionSince::follow(const Change& change) {
  const double determinant = arms2_[0] * arms2_[2] - arms2_[1] * arms2_[1];
  constexpr double fewest = 0.01;  // nm^2, mean squared distance from the axis: less in a single tube along z
  if (!(arms2_[0] > fewest * elements_) || !(determinant > 1e-6 * arms2_[0] * arms2_[2])) return;
  twist_.sine = (change.spin * arms2_[2] - change.spin_z * arms2_[1]) / determinant;
  twist_.slope = (change.spin_z * arms2_[0] - change.spin * arms2_[1]) / determinant;
}

}  // namespace ropewalk
