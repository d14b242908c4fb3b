#include "io/log_mean.hpp"

#include <algorithm>
#include <cmath>

#include "observe/time_mean.hpp"

namespace ropewalk {

std::size_t rows_of_last(double ps, const std::vector<LogRow>& log) {
  const double from = log.back()["time_ps"] - ps - 1e-9;
  return static_cast<std::size_t>(
      std::count_if(log.begin(), log.end(), [&](const LogRow& row) { return row["time_ps"] >= from; }));
}

LogMean mean_of_last(std::size_t count, const std::vector<LogRow>& log,
                     const std::function<double(const LogRow&)>& value) {
  std::vector<double> values;
  const std::size_t first = log.size() - count;
  for (std::size_t k = first; k < log.size(); ++k) values.push_back(value(log[k]));
  const TimeMean mean = time_mean(values);
  LogMean out{mean.mean, mean.error};
  if (count < 2) return out;
  const double apart = (log.back()["time_ps"] - log[first]["time_ps"]) / static_cast<double>(count - 1);
  if (mean.rows > 0) out.correlation_ps = mean.rows * apart;
  if (std::isfinite(mean.mean) && !std::isfinite(mean.error)) out.needed_ps = mean.rows_needed * apart;
  return out;
}

}  // namespace ropewalk
