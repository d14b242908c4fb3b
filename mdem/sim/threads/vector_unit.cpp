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

namespace {

const VectorUnit machine_unit = best_unit();
thread_local int unit_of_thread = -1;  // -1: none as yet

}  // namespace

VectorUnit vector_unit_in_use() {
  return unit_of_thread < 0 ? machine_unit : static_cast<VectorUnit>(unit_of_thread);
}
void use_vector_unit(VectorUnit unit) { unit_of_thread = static_cast<int>(unit); }

std::vector<std::string> instruction_sets() {
  std::vector<std::string> sets;
  for (int unit = static_cast<int>(machine_unit); unit >= 0; --unit) sets.emplace_back(names[unit]);
  return sets;
}

std::string instructions_in_use() { return names[static_cast<int>(vector_unit_in_use())]; }

bool use_instructions(const std::string& name) {
  if (name.empty()) {
    use_vector_unit(machine_unit);
    return true;
  }
  for (int unit = 0; unit <= static_cast<int>(machine_unit); ++unit)
    if (name == names[unit]) {
      use_vector_unit(static_cast<VectorUnit>(unit));
      return true;
    }
  return false;
}

}  // namespace ropewalk
