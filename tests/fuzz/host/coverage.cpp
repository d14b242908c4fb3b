// In every program of a build with ROPEWALK_FUZZ; only the fuzzer reads it.
#include "coverage.hpp"

namespace ropewalk::fuzz {

std::array<std::uint8_t, branch_counters> branches_taken;

}  // namespace ropewalk::fuzz

extern "C" {

__attribute__((no_sanitize_coverage)) void __sanitizer_cov_trace_pc() {
  const auto from = reinterpret_cast<std::uintptr_t>(__builtin_return_address(0));
  ++ropewalk::fuzz::branches_taken.data()[from % ropewalk::fuzz::branch_counters];
}

// Comparisons of numbers with a point, which libFuzzer makes nothing of. It has those of whole numbers itself.
void __sanitizer_cov_trace_cmpf(float, float) {}
void __sanitizer_cov_trace_cmpd(double, double) {}

}  // extern "C"
