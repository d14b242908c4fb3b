#include "io/measured.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace ropewalk {

int decimals_of_error(double error) { return std::max(0, 1 - static_cast<int>(std::floor(std::log10(error)))); }

bool vanishes(double value, int decimals) { return std::fabs(value) < 0.5 * std::pow(10.0, -decimals); }

std::string measured_text(double value, double error) {
  constexpr int max_decimals = 9;
  if (!(error > 0) || !std::isfinite(error)) return fmt::format("{:.7g}", value);
  const int decimals = decimals_of_error(error);
  if (vanishes(value, decimals)) return fmt::format("0 ± {:.2g}", error);
  // Small numbers of small errors are clearer with a power of ten.
  if (decimals > max_decimals) return fmt::format("{:.10g} ± {:.2g}", value, error);
  return fmt::format("{:.{}f} ± {:.{}f}", value, decimals, error, decimals);
}

}  // namespace ropewalk
