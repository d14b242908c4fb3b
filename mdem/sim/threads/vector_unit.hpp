// Loops over elements outside the contact kernels, compiled for several vector units: for every x86-64, and for
// those of the levels v3 (AVX2) and v4 (AVX-512). One binary runs on all of them, and sums have other last digits
// on each; so that the unit in use is one that can be chosen, and not the loader's choice.
//
// Such loops stand in a file of their own, NAME_loops-inl.hpp, in namespace ROPEWALK_UNIT:
//   #define ROPEWALK_LOOPS "NAME_loops-inl.hpp"
//   #include "sim/threads/for_each_vector_unit-inl.hpp"
//   ... ROPEWALK_IN_USE(function)(arguments)
#pragma once

namespace ropewalk {

enum class VectorUnit { base, v3, v4 };

// The best of the processor, until another one is chosen.
extern VectorUnit vector_unit_in_use;

}  // namespace ropewalk

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__)
#define ROPEWALK_HAS_VECTOR_UNITS
#define ROPEWALK_IN_USE(function)                                                   \
  (::ropewalk::vector_unit_in_use == ::ropewalk::VectorUnit::v4   ? in_v4::function \
   : ::ropewalk::vector_unit_in_use == ::ropewalk::VectorUnit::v3 ? in_v3::function \
                                                                  : in_base::function)
#else
#define ROPEWALK_IN_USE(function) in_base::function
#endif
