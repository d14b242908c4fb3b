#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "contact/fit_contact.hpp"
#include "contact/line_targets.hpp"

namespace ropewalk::calibrate {
namespace {

constexpr double unit_density = 38;  // atoms per nm^2; the law is in units of it

struct TubePair {
  Shell i, j;
  LineTargets targets;
};

// The five rows, in the order of their parameters.
template <class Law>
auto rows(Law& law) {
  return std::array{&law.log_K, &law.s, &law.c, &law.p, &law.q};
}

void set_rows(const std::vector<double>& p, UniversalLine& law) {
  auto value = p.begin();
  for (UniversalLine::Row* row : rows(law))
    for (double& a : *row) a = *value++;
}

// Bounds around the values of a tube of medium radius; x lies between 0.2 and 1.2, y below 0.3.
std::vector<FitParameter> box() {
  struct Bounds {
    const char* name;
    double start, below, above, slope;
  };
  const Bounds ranges[] = {{"ln K", 2, 0, 4, 10},
                           {"s", 0.75, 0.3, 2, 3},
                           {"c", -0.07, -0.4, 1, 3},
                           {"p", 9, 5.6, 20, 60},
                           {"q", 4.2, 2, 5.4, 10}};
  static const char* const powers[] = {" 1", " x", " x^2", " x^3", " y", " x y"};
  std::vector<FitParameter> out;
  for (const Bounds& r : ranges)
    for (int k = 0; k < UniversalLine::terms; ++k) {
      if (k == 0)
        out.push_back({std::string(r.name) + powers[k], r.start, r.below, r.above});
      else
        out.push_back({std::string(r.name) + powers[k], 0, -r.slope, r.slope});
    }
  return out;
}

LineDensity density_of(const UniversalLine& law, const TubePair& pair) {
  return law.density(pair.i.radius, pair.i.density, pair.j.radius, pair.j.density);
}

// The law is defined only if h + c is positive at the core and p is above q.
bool sound(const LineDensity& d) { return d.core_gap + d.c > 0.05 * d.s && d.s > 0 && d.p > d.q + 0.2 && d.q > 1; }

FitResult fit_rows(const std::vector<TubePair>& pairs, UniversalLine& law) {
  std::size_t size = 0;
  for (const TubePair& pair : pairs) size += pair.targets.size();
  const auto residuals = [&](const std::vector<double>& p, std::vector<double>& r) {
    set_rows(p, law);
    double* out = r.data();
    for (const TubePair& pair : pairs) {
      const LineDensity d = density_of(law, pair);
      if (sound(d))
        pair.targets.residuals(d, out);
      else
        std::fill(out, out + pair.targets.size(), std::numeric_limits<double>::quiet_NaN());
      out += pair.targets.size();
    }
  };
  FitOptions options;
  options.starts = 2;
  options.max_evaluations = 400000;
  const FitResult fit = fit_least_squares(box(), size, residuals, options);
  set_rows(fit.value, law);
  return fit;
}

UniversalFit::PairCheck compare(const TubePair& pair, const AtomLaw& law, const UniversalLine& universal) {
  LineDensity direct = with_gaps(line_gaps(law), pair.i.radius + pair.j.radius);
  FitOptions options;
  options.starts = 1;
  fit_density(pair.targets, law, unit_of_K(law, pair.i, pair.j), options, direct);
  const LineDensity d = density_of(universal, pair);
  const LineWell well = line_parallel_well(d);
  return {pair.i.radius,
          pair.j.radius,
          pair.targets.error(direct),
          pair.targets.error(d),
          well.distance / pair.targets.parallel_well.distance - 1,
          well.energy / pair.targets.parallel_well.energy - 1};
}

}  // namespace

UniversalFit fit_universal(const AtomLaw& law, const std::vector<std::pair<double, double>>& radii) {
  if (radii.empty()) throw std::invalid_argument("universal contact: give at least one pair of radii");
  const LineGaps gaps = line_gaps(law);
  std::vector<TubePair> pairs;
  for (const auto& [ri, rj] : radii) {
    const Shell i{ri, unit_density}, j{rj, unit_density};
    pairs.push_back({i, j, LineTargets(WallsIntegral(law, i, j), ri + rj, gaps)});
  }
  UniversalFit out;
  out.law.epsilon = law.epsilon;
  out.law.sigma = law.sigma;
  out.law.lj_cutoff = std::isfinite(law.cutoff) ? law.cutoff : 0;
  out.law.core_gap = gaps.core;
  out.law.switch_gap = gaps.switching;
  out.law.cutoff_gap = gaps.cutoff;
  out.fit = fit_rows(pairs, out.law);
  auto error = out.fit.standard_error.begin();
  for (UniversalLine::Row* row : {&out.se_log_K, &out.se_s, &out.se_c, &out.se_p, &out.se_q})
    for (double& a : *row) a = *error++;
  for (const TubePair& pair : pairs) {
    out.pairs.push_back(compare(pair, law, out.law));
    out.error = std::max(out.error, out.pairs.back().error);
  }
  return out;
}

}  // namespace ropewalk::calibrate
