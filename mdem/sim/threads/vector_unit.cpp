#include "sim/threads/vector_unit.hpp"

namespace ropewalk {
namespace {

VectorUnit best_unit() {
#ifdef ROPEWALK_HAS_VECTOR_UNITS
  __builtin_cpu_init();
  if (__builtin_cpu_supports("x86-64-v4")) return VectorUnit::v4;
  if (__builtin_cpu_supports("x86-64-v3")) return VectorUnit::v3;
#endif
  return VectorUnit::base;
}

}  // namespace

VectorUnit vector_unit_in_use = best_unit();

}  // namespace ropewalk
