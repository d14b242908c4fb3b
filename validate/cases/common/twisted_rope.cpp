#include "cases/common/twisted_rope.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "cases/common/chain.hpp"
#include "cases/common/tube_curve.hpp"
#include "io/grade.hpp"
#include "model/error.hpp"

namespace ropewalk::validate {
namespace {

// A part of the range of each column: the error of the minimiser.
constexpr double fresh_tolerance = 0.01;

struct Series {
  std::string tube, grips;  // "(5,5)"; "fixed", "free"
  std::vector<TwistedState> atoms, elements;
  std::size_t elastic = 0;  // the last increment that is compared with the tolerances of the elastic range
  int colour = 0;

  std::string name() const { return tube + ", grips " + grips; }
  std::string at(std::size_t k) const {
    return fmt::format(", grips {}, {:.4g} deg", grips, atoms[k].angle * units::rad_in_degree);
  }
};

std::vector<double> each(const std::vector<TwistedState>& states, double TwistedState::*value, double from = 0) {
  std::vector<double> out;
  for (const TwistedState& s : states) out.push_back(s.*value - from);
  return out;
}

std::vector<double> degrees(const std::vector<TwistedState>& states) {
  std::vector<double> out;
  for (const TwistedState& s : states) out.push_back(s.angle * units::rad_in_degree);
  return out;
}

// Difference from the atoms in percent; NaN in the first increment, where the atoms have almost none.
std::vector<double> residuals(const Series& series, double TwistedState::*value) {
  std::vector<double> out;
  for (std::size_t k = 0; k < series.atoms.size(); ++k)
    out.push_back(k > 0 ? 100 * (series.elements[k].*value / series.atoms[k].*value - 1)
                        : std::numeric_limits<double>::quiet_NaN());
  return out;
}

// Energies of an increment above those of the first.
TwistedState change(const std::vector<TwistedState>& states, std::size_t k) {
  TwistedState out = states[k];
  out.total -= states[0].total;
  out.tubes -= states[0].tubes;
  out.vdw -= states[0].vdw;
  out.bending -= states[0].bending;
  return out;
}

std::array<std::size_t, 3> compared(const Series& s) { return {(s.elastic + 2) / 3, 2 * s.elastic / 3, s.elastic}; }

// The error bar of the twisting energy by the registry of real tubes, which the model leaves out, over that energy:
// the registries of twelve pairs of neighbours at random. It falls with the square of the angle. 0: not known.
double registry_bar(const ParameterSet& set, const Series& series, std::size_t k) {
  return std::max(0.0, registry_deviation(set)) * std::fabs(series.atoms[k].vdw) / std::sqrt(12.0) /
         change(series.atoms, k).total;
}

void add_checks(const ParameterSet& set, const Series& series, CaseResult& result) {
  for (const std::size_t k : compared(series)) {
    const TwistedState atoms = change(series.atoms, k), elements = change(series.elements, k);
    const std::string at = series.at(k), tube = series.tube + ": ";
    const double registry = registry_bar(set, series, k);
    result.check_relative(tube + "twisting energy" + at, elements.total, atoms.total, std::hypot(0.02, registry),
                          "eV", "2 %, and the error bar of registry");
    result.check_relative(tube + "energy inside of the tubes" + at, elements.tubes, atoms.tubes, 0.02, "eV");
    result.check_relative(tube + "vdW energy" + at, series.elements[k].vdw, series.atoms[k].vdw, 0.10, "eV",
                          "of the twisted rope, whole");
    result.check_absolute(
        tube + "vdW part of the twisting energy" + at, elements.vdw / elements.total, atoms.vdw / atoms.total,
        std::hypot(0.01, 2 * registry), "1",
        "relative to the twisting energy: 1 %, and two error bars of registry, which smooth tubes do not have");
    result.check_relative(tube + "end moment" + at, elements.moment, atoms.moment, 0.05, "eV");
  }
}

// Beyond the collapse.
void add_collapsed_checks(const RopeComparison& c, const Series& series, CaseResult& result) {
  for (std::size_t k = 0; k < series.atoms.size(); ++k)
    for (const double degrees : c.collapsed) {
      if (std::fabs(series.atoms[k].angle * units::rad_in_degree - degrees) > 0.01) continue;
      const TwistedState atoms = change(series.atoms, k), elements = change(series.elements, k);
      result.check_relative(fmt::format("{}: twisting energy of collapsed tubes, {:.4g} deg", series.tube, degrees),
                            elements.total, atoms.total, 0.10, "eV");
    }
}

std::vector<double> angles_in(const Series& series) {
  std::vector<double> angles;
  for (const TwistedState& s : series.atoms) angles.push_back(s.angle);
  return angles;
}

// The same rope with Euler-Bernoulli bonds, as in the published model, shows the effect of shear.
void add_shear_information(const TwistedRope& rope, ParameterSet set, const Series& series, CaseResult& result) {
  set.bond.shear = 0;
  set.anharmonic.reset();
  Series rigid = series;
  rigid.elements = twist_elements(rope, set, angles_in(series), series.grips == "free");
  for (const std::size_t k : compared(series)) {
    const TwistedState atoms = change(rigid.atoms, k), elements = change(rigid.elements, k);
    result.show_relative(series.tube + ": twisting energy with bonds rigid in shear" + series.at(k), elements.total,
                         atoms.total, 0.05, "eV", "the published kind of bond, for comparison");
  }
}

void add_registry_information(const ParameterSet& set, const Series& series, CaseResult& result) {
  if (registry_deviation(set) < 0) return;
  for (const std::size_t k : compared(series))
    result.show_absolute(
        series.tube + ": registry over twisting energy" + series.at(k), 0, registry_bar(set, series, k), 0, "1",
        fmt::format(
            "error bar of the twisting energy: {:.2g} % of the vdW energy a pair, of 12 pairs at random; the "
            "model has no registry",
            100 * registry_deviation(set)));
}

// Shortening is of second order in the angle, and softer in the atoms.
void add_axial_information(const Series& series, CaseResult& result) {
  const std::size_t k = series.elastic;
  const char* note =
      "shown only: rises with the square of the angle, and depends on how the clamps take up the strain";
  const auto add = [&](const std::string& name, double TwistedState::*value, const char* unit) {
    result.show_relative(
        fmt::format("{}: {}, {:.4g} deg", series.tube, name, series.atoms[k].angle * units::rad_in_degree),
        series.elements[k].*value - series.elements[0].*value, series.atoms[k].*value - series.atoms[0].*value, 0.3,
        unit, note);
  };
  if (series.grips == "fixed")
    add("tension due to the twist, grips fixed", &TwistedState::force, "eV/nm");
  else
    add("rise of the grip, grips free", &TwistedState::rise, "nm");
}

ChartLine points(const Series& s, std::vector<double> values) {
  return {"atoms, " + s.name(), degrees(s.atoms), std::move(values), s.colour, false, false, true};
}

ChartLine line(const Series& s, std::vector<double> values, const std::string& name = "elements") {
  return {name + ", " + s.name(), degrees(s.elements), std::move(values), s.colour, false, false, false};
}

CaseFigure comparison(const std::vector<Series>& all, double TwistedState::*value, bool against_start,
                      const std::string& quantity, const std::string& unit, const std::string& caption) {
  CaseFigure figure = case_figure(quantity + " against the angle between the grips",
                                  {"angle between the grips", "deg"}, {quantity, unit}, caption);
  for (const Series& s : all) {
    const double a = against_start ? s.atoms[0].*value : 0, e = against_start ? s.elements[0].*value : 0;
    figure.chart.lines.push_back(points(s, each(s.atoms, value, a)));
    figure.chart.lines.push_back(line(s, each(s.elements, value, e)));
  }
  return figure;
}

CaseFigure residual_figure(std::vector<Series> all) {
  CaseFigure figure = case_figure(
      "Elements against atoms", {"angle between the grips", "deg"}, {"elements over atoms", "%"},
      "Relative differences. At small angles the moment of atoms has a part due to registry that does not grow "
      "with the angle.");
  for (Series& s : all) {
    figure.chart.lines.push_back(line(s, residuals(s, &TwistedState::moment), "end moment"));
    figure.chart.lines.back().dashed = true;
    for (auto* states : {&s.atoms, &s.elements}) {
      const double start = (*states)[0].total;
      for (TwistedState& state : *states) state.total -= start;
    }
    figure.chart.lines.push_back(line(s, residuals(s, &TwistedState::total), "twisting energy"));
  }
  return figure;
}

void add_figures(const std::vector<Series>& all, CaseResult& result) {
  result.figures.push_back(comparison(all, &TwistedState::total, true, "twisting energy", "eV",
                                      "Total energy above that of the untwisted rope."));
  result.figures.push_back(residual_figure(all));
  result.figures.push_back(
      comparison(all, &TwistedState::tubes, true, "energy inside of the tubes", "eV",
                 "Stretch, bending and torsion of the tubes make up nearly all of the twisting energy."));
  result.figures.push_back(
      comparison(all, &TwistedState::vdw, true, "change of the vdW energy", "eV",
                 "The energy between tubes, above that of the untwisted rope, is a small part."));
  result.figures.push_back(
      comparison(all, &TwistedState::moment, false, "end moment", "eV", "Moment on the upper grip."));
}

// The elastic range: to this twist the torsional stiffness of a single tube stays within 1 %.
constexpr double elastic_shear = 0.0412;  // r tau; steps of the stored tables end at 0.0400 to 0.0409

void compare(const RopeComparison& c, const CaseTube& tube, const CaseContext& context, std::vector<Series>& all,
             CaseResult& result) {
  const TwistedRope rope = rope_of_length(c.name, c.length, tube.set);
  const ReferenceTable table = reference(
      context, tube.set, c.name, fresh_tolerance,
      [&] {
        return twist_atoms(rope, tube.set, angles_of(rope, tube.set, context, c.shear, c.increments), c.axial_free,
                           context);
      },
      result);
  for (const bool axial_free : c.axial_free) {
    Series series;
    series.tube = tube.name;
    series.grips = axial_free ? "free" : "fixed";
    series.colour = static_cast<int>(all.size());
    series.atoms = states_of(table, axial_free);
    if (series.atoms.empty())
      throw InputError({tube.set.name + "/" + c.name + ".csv", 0, ""},
                       fmt::format("has no rows with grips {}", series.grips),
                       "make the reference again with --fresh");
    if (context.progress) context.progress(fmt::format("elements of {}: grips {}", tube.name, series.grips));
    series.elements = twist_elements(rope, tube.model, angles_in(series), axial_free);
    const double shear = tube.set.radius / clamped_length(rope, tube.set);
    for (std::size_t k = 0; k < series.atoms.size(); ++k)
      if (shear * series.atoms[k].angle < elastic_shear) series.elastic = k;
    add_checks(tube.set, series, result);
    add_collapsed_checks(c, series, result);
    add_registry_information(tube.model, series, result);
    add_axial_information(series, result);
    add_shear_information(rope, tube.model, series, result);
    all.push_back(std::move(series));
  }
}

CaseResult run_ropes(const RopeComparison& c, const CaseContext& context) {
  CaseResult result;
  std::vector<Series> all;
  for (const CaseTube& tube : context.tubes()) compare(c, tube, context, all, result);
  add_figures(all, result);
  return result;
}

}  // namespace

std::vector<TwistedState> states_of(const ReferenceTable& table, bool axial_free) {
  const std::vector<double> which = table.column("axial_free"), angle = table.column("angle_rad"),
                            total = table.column("energy_eV"), tubes = table.column("tersoff_eV"),
                            vdw = table.column("vdw_eV"), moment = table.column("moment_eV"),
                            force = table.column("force_eV_nm"), rise = table.column("rise_nm");
  std::vector<TwistedState> states;
  for (std::size_t k = 0; k < which.size(); ++k)
    if ((which[k] > 0.5) == axial_free)
      states.push_back({angle[k], total[k], tubes[k], vdw[k], moment[k], force[k], rise[k]});
  return states;
}

Case twisted_rope_case(const RopeComparison& comparison) {
  Case c;
  c.name = comparison.name;
  c.tier = Case::Tier::full;
  c.run = [comparison](const CaseContext& context) { return run_ropes(comparison, context); };
  c.tables = {comparison.name};
  c.lammps_seconds = [comparison](const ParameterSet& set) {
    return 7 * lammps_seconds(set, comparison.length + 2,
                              static_cast<double>(comparison.axial_free.size()) * (comparison.increments + 1));
  };
  return c;
}

}  // namespace ropewalk::validate
