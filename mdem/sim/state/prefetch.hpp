// Asks the memory early for what will be read: where elements of many tubes meet, these lie all over it, and no
// processor guesses where the next ones are.
#pragma once

#include <hwy/base.h>
#include <hwy/cache_control.h>

#include "sim/state/state.hpp"

namespace ropewalk {

// The elements begin .. end - 1, of which there are some.
HWY_INLINE void ask_for(const Vec3Array& v, int begin, int end) {
  constexpr int line = 8;  // numbers that come together
  for (const std::vector<double>* c : {&v.x, &v.y, &v.z}) {
    for (int at = begin; at < end; at += line) hwy::Prefetch(c->data() + at);
    hwy::Prefetch(c->data() + end - 1);
  }
}

}  // namespace ropewalk
