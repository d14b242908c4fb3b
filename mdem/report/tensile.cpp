#include "report/tensile.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "io/pull.hpp"

namespace ropewalk {
namespace {

constexpr double half_stress = 0.5;  // part of the largest stress

struct TensileQuantity {
  OutputColumn column;
  double TensileTest::*value;
};
const TensileQuantity tensile_quantities[] = {
    {{"strength_GPa", "GPa", "largest stress"}, &TensileTest::strength},
    {{"strength_N_per_tex", "N/tex", "the same over the mass per length"}, &TensileTest::specific},
    {{"strain", "", "strain since the pull began, at the largest stress"}, &TensileTest::strain},
    {{"modulus_GPa", "GPa", "slope of a straight line through the stress up to half of the largest"},
     &TensileTest::modulus},
    {{"toughness_MJ_per_m3", "MJ/m^3", "work of the pull, until the stress has fallen to half of the largest"},
     &TensileTest::toughness},
    {{"toughness_J_per_g", "J/g", "the same over the mass"}, &TensileTest::specific_toughness},
    {{"links", "", "links that have formed"}, &TensileTest::links},
    {{"links_broken", "", "links that have broken"}, &TensileTest::links_broken},
    {{"bonds_broken", "", "bonds of tubes that have broken"}, &TensileTest::bonds_broken},
    {{"breaks_at_nm", "nm", "median height of what has broken"}, &TensileTest::breaks_at},
    {{"breaks_within_nm", "nm", "between the quartiles of these heights"}, &TensileTest::breaks_within},
};

double height_quantile(const std::vector<double>& sorted, double part) {
  if (sorted.empty()) return NAN;
  const double at = part * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(at);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (at - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

}  // namespace

TensileTest tensile_test(const std::vector<LogRow>& log, std::vector<double> heights_of_breaks) {
  const std::optional<LoggedPull> pull = pull_of(log);
  if (!pull) throw std::invalid_argument("nothing pulls in it");
  TensileTest t;
  t.strength = pull->strength;
  t.specific = log[pull->most]["specific_stress_N_per_tex"];
  t.before = log[pull->begin];
  t.strain = pull->strain;
  t.modulus = pull->modulus;
  t.no_strength = pull->no_strength;
  for (std::size_t k = pull->begin + 1; k < log.size() && !t.to_half; ++k) {
    const double strain = log[k]["ends_strain"] - log[k - 1]["ends_strain"];
    t.toughness += 1e3 * strain * 0.5 * (log[k]["stress_GPa"] + log[k - 1]["stress_GPa"]);
    t.specific_toughness +=
        1e3 * strain * 0.5 * (log[k]["specific_stress_N_per_tex"] + log[k - 1]["specific_stress_N_per_tex"]);
    t.to_half = k > pull->most && log[k]["stress_GPa"] < half_stress * t.strength;
  }
  if (!t.no_strength.empty()) {
    for (double* of_pull : {&t.strength, &t.specific, &t.strain, &t.modulus, &t.toughness, &t.specific_toughness})
      *of_pull = NAN;
    t.to_half = false;
  }
  t.links = log.back()["links_formed"];
  t.links_broken = log.back()["links_broken"];
  t.bonds_broken = log.back()["bonds_broken"];
  std::sort(heights_of_breaks.begin(), heights_of_breaks.end());
  t.breaks_at = height_quantile(heights_of_breaks, 0.5);
  t.breaks_within = height_quantile(heights_of_breaks, 0.75) - height_quantile(heights_of_breaks, 0.25);
  return t;
}

LoadTest load_test(const TensileTest& test) {
  LoadTest out{test.before, {}, test.to_half};
  out.why_none = test.no_strength;
  for (const TensileQuantity& q : tensile_quantities) out.values.push_back(test.*q.value);
  return out;
}

const LoadTestKind& tensile_kind() {
  static const LoadTestKind kind = [] {
    LoadTestKind k{"Strength",
                   "Stress is the tension over the cells of the tubes in a cross-section. The work of the pull is "
                   "counted until the stress has fallen to half of its largest value. The column \"to half\" "
                   "counts the runs that went on until then.",
                   "strength",
                   "GPa",
                   {},
                   true};
    for (const TensileQuantity& q : tensile_quantities) k.columns.push_back(q.column);
    return k;
  }();
  return kind;
}

}  // namespace ropewalk
