// The vector unit in use: loops over elements and the contact kernels (sim/vectors/base.hpp) are compiled for every
// x86-64, and for those of the levels v3 (AVX2) and v4 (AVX-512). One binary runs on all of them. Sums have other
// last digits on each, so that the unit can be chosen.
//
// Loops stand in a file of their own, NAME_loops-inl.hpp, in namespace ROPEWALK_UNIT:
//   #define ROPEWALK_LOOPS "NAME_loops-inl.hpp"
//   #include "sim/threads/for_each_vector_unit-inl.hpp"
//   ... ROPEWALK_IN_USE(function)(arguments)
#pragma once

#include <string>
#include <vector>

namespace ropewalk {

enum class VectorUnit { base, v3, v4 };

// The unit of this thread and of the teams that it makes (in_team(), for_each()): simulations in several threads
// of a process may have units of their own. The best of the processor, until another one is chosen.
VectorUnit vector_unit_in_use();
void use_vector_unit(VectorUnit unit);

// Names of the units that this machine has, best first.
std::vector<std::string> instruction_sets();
std::string instructions_in_use();
// Chooses a unit for this thread by its name; "" chooses the best. Returns false where there is none of that name.
bool use_instructions(const std::string& name);

}  // namespace ropewalk

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__)
#define ROPEWALK_HAS_VECTOR_UNITS
#define ROPEWALK_IN_USE(function)                                                     \
  (::ropewalk::vector_unit_in_use() == ::ropewalk::VectorUnit::v4   ? in_v4::function \
   : ::ropewalk::vector_unit_in_use() == ::ropewalk::VectorUnit::v3 ? in_v3::function \
                                                                    : in_base::function)
#else
#define ROPEWALK_IN_USE(function) in_base::function
#endif
