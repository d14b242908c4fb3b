// Includes the file HWY_TARGET_INCLUDE once for every instruction set but the last, which is made by the rest of
// the translation unit.
#include "hwy/base.h"

#ifndef ROPEWALK_HWY_FOREACH_TARGET
#define ROPEWALK_HWY_FOREACH_TARGET

#if HWY_TARGETS & HWY_AVX3
#define HWY_TARGET HWY_AVX3
#include HWY_TARGET_INCLUDE
#include "hwy/next_target.h"
#endif

#if HWY_TARGETS & HWY_AVX2
#define HWY_TARGET HWY_AVX2
#include HWY_TARGET_INCLUDE
#include "hwy/next_target.h"
#endif

#define HWY_TARGET HWY_STATIC_TARGET

#endif
