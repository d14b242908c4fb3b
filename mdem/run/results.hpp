// What came of a run, from its log.csv, limits.json and events.csv.
#pragma once

#include "io/run_results.hpp"
#include "run/run_directory.hpp"

namespace ropewalk {

// None where there is no file.
std::vector<LimitRecord> limits_of(const RunDirectory& dir);
RunResults results_of(const RunDirectory& dir);
// The same, which also says at which clamp the first tube broke.
RunResults results_of(const RunDirectory& dir, const Prepared& prepared);

}  // namespace ropewalk
