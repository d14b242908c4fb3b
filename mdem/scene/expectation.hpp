// [[expect]] what a run of the scene should give: the scene carries its own result, and a bug report is a test.
#pragma once

#include <optional>
#include <string>

namespace ropewalk {

struct Expectation {
  std::string column;        // of the log
  std::optional<double> at;  // ps; none: the last row
  double value = 0;          // in the unit of the column
  double tolerance = 0;      // absolute, likewise
};

}  // namespace ropewalk
