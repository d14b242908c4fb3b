// [periodic] the interior of a long rope: a slice that goes on at both ends as its own image.
//
// The first and the last elements of every tube are images. With the period L along z, the length of the elements
// between them, and the twist per length tau, the image of the element at x one period higher is
//
//   x' = R(tau L) x + L e_z,   q' = R(tau L) q,   v' = R(tau L) v + tau' L e_z x R(tau L) x,   R about the z axis,
//
// and one period lower the inverse. So the slice is that of an endless rope that is twisted evenly, and that
// repeats itself after L but for the turn. Images are elements as all others: forces on the elements between them
// are those of the endless rope, as long as the images reach as far as the contact. What moves the images gives the
// gauges: torque and tension of the rope.
#pragma once

#include <vector>

#include "scene/key_table.hpp"
#include "sim/dynamics/gauges.hpp"
#include "sim/dynamics/schedule.hpp"

namespace ropewalk {

class PeriodicLoad : public Load {
 public:
  int images = 0;                      // elements at each end of a tube; 0: as the contact needs
  std::vector<Schedule::Point> twist;  // rad/nm

  // For the tubes of a scene. `reach` (nm): of the contact, between element centres. Throws InputError where tubes
  // are not alike or too short for as many images.
  PeriodicLoad on_tubes(const Topology& topology, double reach, const std::string& path) const;
  // Winds straight tubes evenly about the z axis where the slice is twisted from the start.
  void wind(State&) const;
  // Puts the images where they belong.
  void place(const Topology&, State&) const;
  EndElements ends() const { return ends_; }  // the images
  double period() const { return period_; }   // nm
  const Schedule& schedule() const { return schedule_; }

  std::shared_ptr<Load> copy() const override { return std::make_shared<PeriodicLoad>(*this); }
  Order order() const override { return Order::prescribed_motion; }
  void constrain(const Topology&, double time, double ahead, State&) const override;
  std::string needs_time() const override { return "the images of a periodic slice follow it in time"; }

 private:
  // Calls act(image, original, sign of the period between them).
  template <class Act>
  void for_images(const Topology&, const Act& act) const;
  void follow(int image, int original, double sign, double time, double drift, State&) const;

  Schedule schedule_;  // of tau, smoothed
  EndElements ends_;
  double period_ = 0;  // nm
};

const KeyTable<PeriodicLoad>& periodic_table();

}  // namespace ropewalk
