// The largest motion in one step that still counts as motion. A faster element has blown up: the run ends.
#pragma once

#include <cmath>

#include "sim/state/motion.hpp"

namespace ropewalk {

struct MotionBound {
  static constexpr double radii = 0.25;  // radii of the largest tube, moved in one step
  static constexpr double turn = 0.5;    // rad, turned in one step

  double speed2, spin2;  // nm^2/ps^2, 1/ps^2

  // radius in nm, step in ps.
  MotionBound(double radius, double step) : speed2(square(radii * radius / step)), spin2(square(turn / step)) {}
  // False for velocities that are not finite as well.
  bool holds(const Fastest& f) const { return f.speed2 < speed2 && f.spin2 < spin2 && std::isfinite(f.sum); }

 private:
  static double square(double x) { return x * x; }
};

}  // namespace ropewalk
