#include "observe/growth.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ropewalk {

std::optional<StraightLine> line_through(const std::vector<double>& x, const std::vector<double>& y) {
  const auto n = static_cast<double>(x.size());
  double mx = 0, my = 0, xx = 0, xy = 0, squares = 0;
  for (std::size_t k = 0; k < x.size(); ++k) mx += x[k] / n, my += y[k] / n;
  for (std::size_t k = 0; k < x.size(); ++k) xx += (x[k] - mx) * (x[k] - mx), xy += (x[k] - mx) * (y[k] - my);
  if (!(xx > 0)) return {};
  StraightLine l;
  l.b = xy / xx;
  l.a = my - l.b * mx;
  for (std::size_t k = 0; k < x.size(); ++k) squares += std::pow(y[k] - l.a - l.b * x[k], 2);
  const double variance = n > 2 ? squares / (n - 2) : std::numeric_limits<double>::quiet_NaN();
  l.b_error = std::sqrt(variance / xx);
  l.a_error = std::sqrt(variance * (1 / n + mx * mx / xx));
  return l;
}

Growth growth_of(const std::vector<double>& time, const std::vector<double>& y) {
  std::vector<double> t, l;
  for (std::size_t k = 0; k < std::min(time.size(), y.size()); ++k)
    if (y[k] > 0 && std::isfinite(y[k])) t.push_back(time[k]), l.push_back(std::log(y[k]));
  Growth g;
  g.error = std::numeric_limits<double>::infinity();
  const auto line = line_through(t, l);
  if (!line) return g;
  g.rate = line->b;
  if (t.size() < 4) return g;
  double squares = 0, neighbours = 0, before = 0;
  for (std::size_t k = 0; k < t.size(); ++k) {
    const double left = l[k] - line->a - line->b * t[k];
    squares += left * left;
    neighbours += k > 0 ? left * before : 0;
    before = left;
  }
  const auto n = static_cast<double>(t.size());
  const double r = squares > 0 ? std::clamp(neighbours / squares, 0.0, 0.98) : 0.0;
  const double independent = std::max(n * (1 - r) / (1 + r) - 2, 1.0);
  g.error = line->b_error * std::sqrt((n - 2) / independent);
  return g;
}

}  // namespace ropewalk
