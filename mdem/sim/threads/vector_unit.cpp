#include "sim/threads/vector_unit.hpp"

namespace ropewalk {
namespace {

constexpr const char* names[] = {"baseline", "AVX2", "AVX512"};

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

std::vector<std::string> instruction_sets() {
  std::vector<std::string> sets;
  for (int unit = static_cast<int>(best_unit()); unit >= 0; --unit) sets.emplace_back(names[unit]);
  return sets;
}

std::string instructions_in_use() { return names[static_cast<int>(vector_unit_in_use)]; }

bool use_instructions(const std::string& name) {
  const VectorUnit best = best_unit();
  if (name.empty()) {
    vector_unit_in_use = best;
    return true;
  }
  for (int unit = 0; unit <= static_cast<int>(best); ++unit)
    if (name == names[unit]) {
      vector_unit_in_use = static_cast<VectorUnit>(unit);
      return true;
    }
  return false;
}

}  // namespace ropewalk
