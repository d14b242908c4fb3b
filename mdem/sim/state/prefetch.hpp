// Prefetches elements that will be read soon. The neighbours of an element lie on many tubes, far apart in memory,
// so that the processor cannot predict the addresses.
#pragma once

#include "sim/state/state.hpp"

namespace ropewalk {

// The elements begin .. end - 1, of which there are some.
inline void prefetch(const Vec3Array& v, int begin, int end) {
  constexpr int line = 8;  // numbers that come together
  for (const Column* c : {&v.x, &v.y, &v.z}) {
    for (int at = begin; at < end; at += line) __builtin_prefetch(c->data() + at);
    __builtin_prefetch(c->data() + end - 1);
  }
}

}  // namespace ropewalk
