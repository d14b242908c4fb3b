// The runs behind `ropewalk errors --numerics`: a run again with elements of half the length, half the time step
// and half the rate (in a relaxation: a tenth of the tolerance), each by itself, and from other starts with other
// random numbers.
//
// Elements and time step are of second order (io/numeric_errors.hpp), the rate of first: viscous forces go as it.
// The run with shorter elements has the same part of its own stability limit as time step, and with it less of the
// error of the step as well.
#pragma once

#include <string>
#include <vector>

#include "io/numeric_errors.hpp"
#include "run/run_directory.hpp"

namespace ropewalk {

struct NumericRun {
  std::string folder;  // below `errors`
  std::string words;   // "half the rate"
  std::string scene;   // its text
  double cost = 1;     // processor time over that of the run
  double times = 1;    // duration over that of the run
};

struct NumericPlan {
  std::vector<NumericRun> runs;
  NumericRuns what;
};

// Every scene of it has been prepared. What a scene does not allow is in what.remarks. `scene`, `prepared` and
// `log` are those of the run in `base`.
NumericPlan numeric_plan(const RunDirectory& base, const Scene& scene, const Prepared& prepared,
                         const std::vector<LogRow>& log);

}  // namespace ropewalk
