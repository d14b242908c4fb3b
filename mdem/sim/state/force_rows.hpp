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

// The same to read.
struct ForcesOn {
  const Vec3Array& force;
  const Vec3Array& torque;
  std::ptrdiff_t origin = 0;

  ForcesOn(const Vec3Array& f, const Vec3Array& t, std::ptrdiff_t first) : force(f), torque(t), origin(first) {}
  ForcesOn(const ForceRows& rows) : ForcesOn(rows.force, rows.torque, rows.origin) {}
};

}  // namespace ropewalk
