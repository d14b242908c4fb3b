#include "io/pull.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace ropewalk {
namespace {

constexpr double slack_stress = 0.1;  // part of the largest stress
constexpr double at_rest = 0.5;       // part of the largest stress or its strain: a rope at rest moves by less

// Slope of the least squares line through the rows [from, to].
double slope_of(const std::vector<LogRow>& log, std::size_t from, std::size_t to) {
  double n = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (std::size_t k = from; k <= to; ++k) {
    const double e = log[k]["ends_strain"], s = log[k]["stress_GPa"];
    n += 1, x += e, y += s, xx += e * e, xy += e * s;
  }
  const double spread = n * xx - x * x;
  return spread > 0 ? (n * xy - x * y) / spread : NAN;
}

std::string why_no_strength(const std::vector<LogRow>& log, const LoggedPull& p) {
  if (p.modulus <= 0) return fmt::format("its stress does not rise with its strain: modulus {:.3g} GPa", p.modulus);
  const double first = log[p.begin]["stress_GPa"];
  double least = first;
  for (std::size_t k = p.begin; k < p.most; ++k) least = std::min(least, log[k]["stress_GPa"]);
  if (first - least > at_rest * p.strength)
    return fmt::format("its stress fell to {:.3g} GPa after the pull began: it was not at rest", least);
  std::size_t bears = p.begin;
  while (bears < p.most && log[bears]["stress_GPa"] <= slack_stress * p.strength) ++bears;
  const double slack = log[bears]["ends_strain"] - log[p.begin]["ends_strain"];
  if (slack > at_rest * p.strain)
    return fmt::format("it grew longer by {:.3g} of its length before it bore a tenth of that: it was not at rest",
                       slack);
  return "";
}

}  // namespace

std::optional<LoggedPull> pull_of(const std::vector<LogRow>& log) {
  const LogRow* strongest = strongest_row(log);
  if (!strongest) return std::nullopt;
  LoggedPull p;
  p.most = static_cast<std::size_t>(strongest - log.data());
  p.strength = (*strongest)["stress_GPa"];
  const double at_most = (*strongest)["ends_strain"];
  double least = at_most;
  for (std::size_t k = 0; k < p.most; ++k) least = std::min(least, log[k]["ends_strain"]);
  const double still = least + 1e-3 * (at_most - least), moved = 1e-4 * (at_most - least);
  p.begin = p.most;
  while (p.begin > 0 && log[p.begin]["stress_GPa"] > slack_stress * p.strength &&
         log[p.begin]["ends_strain"] > still)
    --p.begin;
  while (p.begin > 0 && log[p.begin]["ends_strain"] - log[p.begin - 1]["ends_strain"] > moved) --p.begin;
  p.strain = at_most - log[p.begin]["ends_strain"];
  const double middle = 0.5 * (log[p.begin]["stress_GPa"] + p.strength);
  std::size_t half = p.begin;
  while (half < p.most && log[half]["stress_GPa"] < middle) ++half;
  p.modulus = slope_of(log, p.begin, half);
  p.no_strength = why_no_strength(log, p);
  return p;
}

}  // namespace ropewalk
