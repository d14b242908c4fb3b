#include "observe/growth.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ropewalk {

Growth growth_of(const std::vector<double>& time, const std::vector<double>& y) {
  std::vector<double> t, l;
  for (std::size_t k = 0; k < std::min(time.size(), y.size()); ++k)
    if (y[k] > 0 && std::isfinite(y[k])) t.push_back(time[k]), l.push_back(std::log(y[k]));
  Growth g;
  g.values = t.size();
  g.error = std::numeric_limits<double>::infinity();
  const auto n = static_cast<double>(t.size());
  if (t.size() < 2) return g;
  double mean_t = 0, mean_l = 0, tt = 0, tl = 0;
  for (std::size_t k = 0; k < t.size(); ++k) mean_t += t[k] / n, mean_l += l[k] / n;
  for (std::size_t k = 0; k < t.size(); ++k)
    tt += std::pow(t[k] - mean_t, 2), tl += (t[k] - mean_t) * (l[k] - mean_l);
  if (!(tt > 0)) return g;
  g.rate = tl / tt;
  if (t.size() < 4) return g;
  double squares = 0, neighbours = 0, before = 0;
  for (std::size_t k = 0; k < t.size(); ++k) {
    const double left = l[k] - mean_l - g.rate * (t[k] - mean_t);
    squares += left * left;
    neighbours += k > 0 ? left * before : 0;
    before = left;
  }
  const double r = squares > 0 ? std::clamp(neighbours / squares, 0.0, 0.98) : 0.0;
  const double independent = std::max(n * (1 - r) / (1 + r) - 2, 1.0);
  g.error = std::sqrt(squares / n / independent / (tt / n));
  return g;
}

}  // namespace ropewalk
