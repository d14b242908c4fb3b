#pragma once

#include "hwy/base.h"

namespace hwy {

template <class T>
HWY_INLINE void Prefetch(const T* p) {
  __builtin_prefetch(p);
}

}  // namespace hwy
