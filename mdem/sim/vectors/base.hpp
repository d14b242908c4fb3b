// Kernels in explicit vector operations, compiled for three instruction sets: the compiler's default, AVX2 with
// FMA, and AVX-512. The set in use is sim/threads/vector_unit.hpp's. A kernel's file includes itself once for each
// set:
//
//   #undef VEC_SOURCE
//   #define VEC_SOURCE "path/of/this/file.cpp"
//   #include "sim/vectors/each_set-inl.hpp"
//   #include "sim/vectors/operations-inl.hpp"
//   VEC_BEFORE_NAMESPACE();
//   namespace ropewalk::VEC_SET {
//   namespace ops = vec::VEC_SET;
//   ...                                   // compiled for every set
//   }
//   VEC_AFTER_NAMESPACE();
//   #if VEC_ONCE
//   VEC_EXPORT(function);
//   ... VEC_IN_USE(function)(arguments)   // compiled once
//   #endif
//
// The operations have the names and meanings of the library Highway's, which is not used: its version in Debian 12
// is under Apache-2.0, which does not go with LAMMPS's GPL-2. Load and Store need no alignment.
#pragma once

#include <cstddef>
#include <cstdint>

#include "sim/threads/vector_unit.hpp"

#define VEC_INLINE inline __attribute__((always_inline))
#define VEC_NOINLINE __attribute__((noinline))

// Values of VEC_TARGET, the widest first.
#define VEC_AVX512 1
#define VEC_AVX2 2
#define VEC_BASE 4

// Under the sanitizers there is the default set alone: one set shows the errors of all, and the checks in every
// vector operation take the compiler minutes. Clang does not know GCC's pragmas for the other sets.
#ifdef ROPEWALK_HAS_VECTOR_UNITS
#define VEC_HAS_AVX512
#define VEC_HAS_AVX2
#endif
