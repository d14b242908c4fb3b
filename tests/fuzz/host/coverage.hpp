// Counts the branches of the readers that were taken: GCC calls __sanitizer_cov_trace_pc() at each.
#pragma once

#include <array>
#include <cstdint>

namespace ropewalk::fuzz {

// By address, and few enough that looking through them takes no time. Of the branches that one reader has, hardly
// two share a counter.
inline constexpr std::size_t branch_counters = 1 << 16;
extern std::array<std::uint8_t, branch_counters> branches_taken;

}  // namespace ropewalk::fuzz
