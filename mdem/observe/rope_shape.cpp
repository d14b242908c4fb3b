#include "observe/rope_shape.hpp"

#include <algorithm>
#include <cmath>

#include "model/units.hpp"

namespace ropewalk {

const char* name_of(RopeShape shape) {
  switch (shape) {
    case RopeShape::straight:
      return "straight";
    case RopeShape::spindle:
      return "spindle";
    case RopeShape::helix:
      return "helix";
    case RopeShape::brush:
      return "brush";
    case RopeShape::cage:
      return "cage";
    case RopeShape::snarl:
      return "snarl";
  }
  return "";
}

RopeShape rope_shape(const ShapeNumbers& now, double start) {
  constexpr double loop = 0.02, half_a_turn = 0.5, open_ends = 1.5, bent = 0.5, wider = 1.1, hollow = 0.05;
  if (now.turned_back > loop && std::fabs(now.writhe) > half_a_turn) return RopeShape::snarl;
  if (now.radius_end > open_ends * std::max(start, now.radius_mid)) return RopeShape::brush;
  if (now.middle_amplitude > bent * std::max(start, now.radius_mid)) return RopeShape::helix;
  if (!(now.radius_mid > wider * start)) return RopeShape::straight;
  return now.void_area > hollow * units::pi * start * start ? RopeShape::cage : RopeShape::spindle;
}

}  // namespace ropewalk
