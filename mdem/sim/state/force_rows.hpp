// Forces and torques on consecutive elements.
#pragma once

#include <cstddef>

#include "sim/state/state.hpp"

namespace ropewalk {

// Element i has entry i - origin: force in eV/nm, torque about its centre in eV.
struct ForceRows {
  Vec3Array& force;
  Vec3Array& torque;
  std::ptrdiff_t origin = 0;
};

}  // namespace ropewalk
