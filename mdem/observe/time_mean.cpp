#include "observe/time_mean.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ropewalk {

TimeMean time_mean(const std::vector<double>& values) {
  constexpr double window = 5;  // correlation times
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::size_t count = values.size();
  const auto n = static_cast<double>(count);
  TimeMean out{nan, nan, 0, 0, 0};
  if (values.empty()) return out;
  out.mean = 0;
  for (const double v : values) out.mean += v / n;
  const auto covariance = [&](std::size_t apart) {
    double sum = 0;
    for (std::size_t k = apart; k < count; ++k) sum += (values[k] - out.mean) * (values[k - apart] - out.mean);
    return sum / static_cast<double>(count - apart);
  };
  const double variance = covariance(0);
  if (!std::isfinite(variance)) return out;
  // The same at all times, but for rounding.
  if (std::sqrt(variance) <= 1e-14 * std::fabs(out.mean)) {
    out.error = count > 1 ? 0 : nan;
    out.independent = n;
    return out;
  }
  double sum = variance;  // C
  std::size_t last = 0;
  for (std::size_t k = 1; k < count / 2 && static_cast<double>(k) <= window * std::max(0.5, 0.5 * sum / variance);
       ++k) {
    sum += 2 * covariance(k);
    last = k;
  }
  const double corrected = std::max(sum, 0.0) * (1 + (2 * static_cast<double>(last) + 1) / n);
  out.rows = std::max(0.5, 0.5 * corrected / (variance + corrected / n));
  out.independent = n / (2 * out.rows);
  if (out.independent >= least_independent)
    out.error = std::sqrt(corrected / n);
  else
    out.rows_needed = least_independent * 2 * out.rows;
  return out;
}

}  // namespace ropewalk
