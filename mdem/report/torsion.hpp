// Ropes that were twisted until they failed: the largest torque and what came with it.
#pragma once

#include "report/load_tests.hpp"

namespace ropewalk {

// A torsion test as the log of one run has it; the horizontal axis is that of the row with the largest torque.
// Throws std::invalid_argument where nothing twists in the log.
LoadTest torsion_test(const std::vector<LogRow>& log, const RunResults& results);
const LoadTestKind& torsion_kind();

}  // namespace ropewalk
