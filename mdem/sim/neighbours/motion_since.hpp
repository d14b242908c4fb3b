// How far everything has come since some moment, by bounds that what turns a rope as a whole does not count in.
#pragma once

#include <array>
#include <cstddef>

#include "sim/state/motion.hpp"
#include "sim/state/state.hpp"

namespace ropewalk {

class MotionSince {
 public:
  // From here on. With places that are not finite every later change is infinite.
  void start(Vec3Array position, Vec3Array axis);
  // Of the elements begin .. end - 1, of which points move that are up to `lever` (nm) from their centres; infinite
  // where a place is not finite, or where nothing of this size has been started.
  Change change(const State& state, double lever, std::ptrdiff_t begin, std::ptrdiff_t end) const;

  // By no more than twice this have the distance (nm) of two points, and the angle between two axes, changed, if
  // the centres of their elements were no more than `within` apart.
  struct Bound {
    double moved = 0, turned = 0;
  };
  // By the change of all elements, added up in an order that is always the same: the next one is measured against
  // the twist that fits this one best.
  Bound bound(const Change& all, double within, double lever);

  const Vec3Array& position() const { return position_; }
  const Vec3Array& axis() const { return axis_; }
  // The twist that the next change is measured against, in [0] its sine in the middle and in [1] its slope: with
  // it a resumed run finds the same changes.
  std::array<double, 2> twist() const { return {twist_.sine, twist_.slope}; }
  void set_twist(const std::array<double, 2>& t) { twist_.sine = t[0], twist_.slope = t[1]; }
  std::size_t bytes() const { return 3 * (position_.x.capacity() + axis_.x.capacity()) * sizeof(double); }

 private:
  void follow(const Change& change);

  Vec3Array position_, axis_;
  TwistOfAll twist_;
  double farthest_ = 0;          // nm: of all places from its axis
  double arms2_[3] = {0, 0, 0};  // sums of their squared distances from it, times z^0, z^1 and z^2
};

}  // namespace ropewalk
