#include "cases/common/tube_curve.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/checks.hpp"

namespace ropewalk::validate {
namespace {

constexpr int curve_points = 160;
constexpr double give_way = 0.9;  // fraction of the greatest slope so far

double deviation(const TubeCurve& c, std::size_t k) { return c.model(c.amplitude[k]) / c.atoms[k] - 1; }

std::string at_amplitude(const TubeCurve& c, double amplitude) {
  return fmt::format("{} {:.3g}{}{}", c.amplitude_name, amplitude, c.unit.empty() ? "" : " ", c.unit);
}

// The point in the window with the largest difference.
Check window_check(const TubeCurve& c) {
  Check check;
  check.name = c.tube + ": energy up to the limit";
  check.unit = "eV/nm";
  check.tolerance = window_tolerance;
  check.value = check.reference = std::nan("");
  double worst = -1;
  for (std::size_t k = 0; k < c.amplitude.size(); ++k) {
    if (c.amplitude[k] == 0 || std::abs(c.amplitude[k]) > c.window) continue;
    if (std::abs(deviation(c, k)) <= worst) continue;
    worst = std::abs(deviation(c, k));
    check.value = c.model(c.amplitude[k]);
    check.reference = c.atoms[k];
    check.note = fmt::format("the point of largest difference up to {}, at {}", at_amplitude(c, c.window),
                             at_amplitude(c, c.amplitude[k]));
  }
  return check;
}

// The least amplitude of this sign at which the deviation reaches `limit`; NaN where it does not.
double leaving(const TubeCurve& c, double sign, double limit) {
  std::vector<std::pair<double, double>> points;
  for (std::size_t k = 0; k < c.amplitude.size(); ++k)
    if (c.amplitude[k] * sign > 0) points.emplace_back(std::abs(c.amplitude[k]), std::abs(deviation(c, k)));
  std::sort(points.begin(), points.end());
  double x0 = 0, d0 = 0;
  for (const auto& [x, d] : points) {
    if (d >= limit) return x0 + (x - x0) * (limit - d0) / (d - d0);
    x0 = x;
    d0 = d;
  }
  return std::nan("");
}

void add_leaving(const TubeCurve& c, double sign, CaseResult& result) {
  const auto [least, most] = std::minmax_element(c.amplitude.begin(), c.amplitude.end());
  if (sign > 0 ? *most <= 0 : *least >= 0) return;
  const std::string side = *least < 0 ? (sign > 0 ? " (tension)" : " (compression)") : "";
  for (const double limit : {0.05, 0.1}) {
    Check check;
    check.name = fmt::format("{}: energy leaves the atoms by {:.0f} % at{}", c.tube, 100 * limit, side);
    check.value = leaving(c, sign, limit);
    if (!std::isfinite(check.value)) continue;
    check.reference = c.end;
    check.unit = c.unit.empty() ? c.amplitude_name : c.unit;
    check.informative = true;
    check.note = "against the amplitude at which the tube gives way by the set";
    result.checks.push_back(check);
  }
}

CaseFigure energy_figure(const TubeCurve& c) {
  CaseFigure figure =
      case_figure(fmt::format("Energy of {} against {}", c.tube, c.amplitude_name), {c.amplitude_name, c.unit},
                  {"energy per length", "eV/nm"},
                  fmt::format("{}: the tube gives way, by the set, at {}.", c.tube, at_amplitude(c, c.end)));
  ChartLine atoms{"atoms (LAMMPS)", c.amplitude, c.atoms, 0};
  atoms.points = true;
  ChartLine model{"model", {}, {}, 1};
  const auto [least, most] = std::minmax_element(c.amplitude.begin(), c.amplitude.end());
  for (int k = 0; k <= curve_points; ++k) {
    model.x.push_back(*least + (*most - *least) * k / curve_points);
    model.y.push_back(c.model(model.x.back()));
  }
  figure.chart.lines = {model, atoms};
  if (!c.more_amplitude.empty()) {
    ChartLine more{c.more_name, c.more_amplitude, c.more_atoms, 2};
    more.dashed = true;
    figure.chart.lines.push_back(more);
  }
  figure.chart.bands = {{*least < 0 ? -c.window : 0, c.window, "compared", false}};
  return figure;
}

CaseFigure residual_figure(const TubeCurve& c) {
  CaseFigure figure =
      case_figure(fmt::format("Residual of {} against {}", c.tube, c.amplitude_name), {c.amplitude_name, c.unit},
                  {"model against atoms", "%"},
                  fmt::format("{}: relative difference of the energies. The tolerance in the window is {:.0f} %.",
                              c.tube, 100 * window_tolerance));
  figure.chart.height = 200;
  ChartLine line{"model / atoms - 1", {}, {}, 0};
  for (std::size_t k = 0; k < c.amplitude.size(); ++k) {
    if (c.amplitude[k] == 0) continue;
    line.x.push_back(c.amplitude[k]);
    line.y.push_back(100 * deviation(c, k));
  }
  figure.chart.lines = {line};
  figure.chart.bands = {{line.x.front() < 0 ? -c.window : 0, c.window, "compared", false}};
  return figure;
}

}  // namespace

void end_at_collapse(TubeCurve& c) {
  double reach[2] = {0, 0};
  for (const int side : {0, 1}) {
    const double sign = side == 0 ? -1 : 1;
    std::vector<std::pair<double, double>> points;
    for (std::size_t k = 0; k < c.amplitude.size(); ++k)
      if (c.amplitude[k] * sign >= 0) points.emplace_back(std::abs(c.amplitude[k]), c.atoms[k]);
    std::sort(points.begin(), points.end());
    std::vector<double> amplitude, energy;
    for (const auto& [x, y] : points) amplitude.push_back(x), energy.push_back(y);
    reach[side] = amplitude[points_before_collapse(amplitude, energy) - 1];
  }
  c.more_name = "after the collapse";
  std::vector<double> amplitude, atoms;
  for (std::size_t k = 0; k < c.amplitude.size(); ++k) {
    const bool before = std::abs(c.amplitude[k]) <= reach[c.amplitude[k] < 0 ? 0 : 1];
    (before ? amplitude : c.more_amplitude).push_back(c.amplitude[k]);
    (before ? atoms : c.more_atoms).push_back(c.atoms[k]);
  }
  c.amplitude = amplitude;
  c.atoms = atoms;
}

void add_curve(const TubeCurve& curve, CaseResult& result) {
  result.checks.push_back(window_check(curve));
  add_leaving(curve, 1, result);
  add_leaving(curve, -1, result);
  result.figures.push_back(energy_figure(curve));
  result.figures.push_back(residual_figure(curve));
}

std::size_t points_before_collapse(const std::vector<double>& amplitude, const std::vector<double>& energy) {
  double greatest = 0;
  for (std::size_t k = 1; k < energy.size(); ++k) {
    const double slope = (energy[k] - energy[k - 1]) / (amplitude[k] - amplitude[k - 1]);
    if (slope < give_way * greatest) return k;
    greatest = std::max(greatest, slope);
  }
  return energy.size();
}

std::size_t points_before_break(const std::vector<double>& amplitude, const std::vector<double>& energy) {
  constexpr double leap = 4.0 / 3;
  double stiffest = 0;
  for (std::size_t k = 1; k < energy.size(); ++k) {
    const double middle = 0.5 * (amplitude[k] + amplitude[k - 1]);
    const double stiffness = (energy[k] - energy[k - 1]) / (amplitude[k] - amplitude[k - 1]) / middle;
    if (k > 1 && stiffness > leap * stiffest) return k;
    stiffest = std::max(stiffest, stiffness);
  }
  return energy.size();
}

void add_collapse(const TubeCurve& curve, const std::vector<double>& amplitude, std::size_t points,
                  const std::string& note, CaseResult& result) {
  if (points >= amplitude.size()) return;
  Check check;
  check.name = curve.tube + ": the atoms give way at";
  check.value = 0.5 * (amplitude[points - 1] + amplitude[points]);
  check.reference = curve.end;
  check.unit = curve.unit.empty() ? curve.amplitude_name : curve.unit;
  check.informative = true;
  check.note = note;
  result.checks.push_back(check);
}

Case tube_curve_case(const std::string& name, double tolerance,
                     ReferenceTable (*make)(const CaseContext&, const ParameterSet&),
                     void (*compare)(const CaseTube&, const ReferenceTable&, CaseResult&)) {
  Case c;
  c.name = name;
  c.sets = {"cnt-5-5-tersoff", "cnt-10-10-tersoff"};
  c.law = Case::Law::none;
  c.tables = {name};
  c.run = [=](const CaseContext& context) {
    CaseResult result;
    for (const CaseTube& tube : context.tubes())
      compare(tube,
              reference(
                  context, tube.set, name, tolerance, [&] { return make(context, tube.set); }, result),
              result);
    return result;
  };
  return c;
}

double lammps_seconds(const ParameterSet& set, double length, double relaxations) {
  constexpr double per_atom = 1.2e-3;  // s; 500 steps of the minimiser
  return per_atom * set.atoms_per_length * length * relaxations;
}

}  // namespace ropewalk::validate
