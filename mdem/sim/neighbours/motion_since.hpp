// Bounds of the motion of all elements since a reference time. A twist of the whole rope about its axis does not
// count, since it changes the distances between neighbours only little.
#pragma once

#include <array>
#include <cstddef>

#include "sim/state/motion.hpp"
#include "sim/state/state.hpp"

namespace ropewalk {

// Several processes with elements of their own: joins what they know, with the same result for all of them.
class AllProcesses {
 public:
  virtual ~AllProcesses() = default;
  // The largest of the one number, and the sums of the others.
  virtual void join(double& largest, double (&sums)[3]) const = 0;
};

class MotionSince {
 public:
  // Sets the reference. If a position is not finite, every later change is infinite. `topology` says which elements
  // are owned where `others` own the rest.
  void start(const Topology& topology, Vec3Array position, Vec3Array axis, const AllProcesses* others);
  // The change of elements begin .. end - 1 since the reference, with points up to `lever` (nm) from the centres.
  // It is infinite if a position is not finite, or if the reference has another number of elements.
  Change change(const State& state, double lever, std::ptrdiff_t begin, std::ptrdiff_t end) const;

  // Half of the largest possible change (nm) of the distance of two points of elements whose centres were no more
  // than `within` (nm) apart, for the change of all (own) elements. It also fits the common twist, against which
  // the next change is measured; the change must therefore be summed in a fixed order.
  double bound(Change all, double within, double lever);

  const Vec3Array& position() const { return position_; }
  const Vec3Array& axis() const { return axis_; }
  // The common twist against which the next change is measured: [0] is its sine at the middle, [1] its slope. A
  // checkpoint stores it, so that a resumed run finds the same changes.
  std::array<double, 2> twist() const { return {twist_.sine, twist_.slope}; }
  const TwistOfAll& common_twist() const { return twist_; }
  void set_twist(const std::array<double, 2>& t) { twist_.sine = t[0], twist_.slope = t[1]; }
  std::size_t bytes() const { return 3 * (position_.stride() + axis_.stride()) * sizeof(double); }

 private:
  void follow(const Change& change);

  Vec3Array position_, axis_;
  TwistOfAll twist_;
  double farthest_ = 0;  // nm: largest distance of an element from the axis of the twist
  double elements_ = 0;  // number on all processes
  const AllProcesses* others_ = nullptr;
  double arms2_[3] = {0, 0, 0};  // sums of the squared distances from the axis, times z^0, z^1 and z^2
};

}  // namespace ropewalk
