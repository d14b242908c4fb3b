// Includes the file VEC_SOURCE for AVX-512 and AVX2. The rest of the translation unit is compiled for the default
// set.
#include "sim/vectors/base.hpp"

#ifndef VEC_EACH_SET
#define VEC_EACH_SET

#ifdef VEC_HAS_AVX512
#define VEC_TARGET VEC_AVX512
#include VEC_SOURCE
#include "sim/vectors/next_set-inl.hpp"
#endif

#ifdef VEC_HAS_AVX2
#define VEC_TARGET VEC_AVX2
#include VEC_SOURCE
#include "sim/vectors/next_set-inl.hpp"
#endif

#define VEC_TARGET VEC_BASE

#endif
