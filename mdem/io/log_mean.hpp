// The mean of a column over the last part of a log, with its error (observe/time_mean.hpp) and times in ps.
#pragma once

#include <functional>
#include <limits>
#include <vector>

#include "io/log.hpp"

namespace ropewalk {

struct LogMean {
  double value = std::numeric_limits<double>::quiet_NaN();
  double error = std::numeric_limits<double>::quiet_NaN();           // nan: the time is too short for one
  double correlation_ps = std::numeric_limits<double>::quiet_NaN();  // nan: the value does not change
  double needed_ps = 0;                                              // for an error, where there is none
};

// How many rows lie within the last `ps` of a log that is not empty.
std::size_t rows_of_last(double ps, const std::vector<LogRow>& log);

// Over the last `count` rows, of a log with as many or more.
LogMean mean_of_last(std::size_t count, const std::vector<LogRow>& log,
                     const std::function<double(const LogRow&)>& value);

}  // namespace ropewalk
