// What acts on some elements, one after another, wherever it is kept.
#pragma once

#include <cstddef>

#include "sim/state/state.hpp"

namespace ropewalk {

// Of element i at i - origin: eV/nm, and eV about its centre.
struct ForceRows {
  Vec3Array& force;
  Vec3Array& torque;
  std::ptrdiff_t origin = 0;
};

}  // namespace ropewalk
