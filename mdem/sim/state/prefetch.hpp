// Prefetches elements that will be read soon. The neighbours of an element lie on many tubes, far apart in memory,
// so that the processor cannot predict the addresses.
#pragma once

#include <hwy/base.h>
#include <hwy/cache_control.h>

#include "sim/state/state.hpp"

namespace ropewalk {

// The elements begin .. end - 1, of which there are some.
HWY_INLINE void prefetch(const Vec3Array& v, int begin, int end) {
  constexpr int line = 8;  // numbers that come together
  for (const Column* c : {&v.x, &v.y, &v.z}) {
    for (int at = begin; at < end; at += line) hwy::Prefetch(c->data() + at);
    hwy::Prefetch(c->data() + end - 1);
  }
}

}  // namespace ropewalk
