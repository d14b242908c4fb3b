#include "cases/common/twisted_rope.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "cases/common/chain.hpp"
#include "io/grade.hpp"
#include "model/error.hpp"

namespace ropewalk {
namespace {

// Of the range of each column: the error of the minimiser.
constexpr double fresh_tolerance = 0.01;

struct Series {
  std::string grips;  // "fixed", "free"
  std::vector<TwistedState> atoms, elements;
  int colour = 0;
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

void add_checks(const TwistedRope& rope, const Series& series, CaseResult& result) {
  const auto last = static_cast<std::size_t>(rope.elastic_increments);
  for (const std::size_t k : std::array{last / 3, 2 * last / 3, last}) {
    const TwistedState atoms = change(series.atoms, k), elements = change(series.elements, k);
    const std::string at = fmt::format(", grips {}, {:.4g} deg", series.grips, atoms.angle * units::rad_in_degree);
    result.checks.push_back(relative_check("twisting energy" + at, elements.total, atoms.total, 0.02, "eV"));
    result.checks.push_back(
        relative_check("energy inside of the tubes" + at, elements.tubes, atoms.tubes, 0.02, "eV"));
    result.checks.push_back(relative_check("vdW energy" + at, series.elements[k].vdw, series.atoms[k].vdw, 0.10,
                                           "eV", "of the twisted rope, whole"));
    result.checks.push_back(absolute_check(
        "vdW part of the twisting energy" + at, elements.vdw / elements.total, atoms.vdw / atoms.total, 0.01, "1",
        "relative to the twisting energy: the change of the vdW energy is smaller than its corrugation by registry "
        "(1 to 3 %), which smooth tubes do not have"));
    result.checks.push_back(relative_check("end moment" + at, elements.moment, atoms.moment, 0.05, "eV"));
  }
}

// Beyond the collapse.
void add_collapsed_checks(const TwistedRope& rope, const Series& series, CaseResult& result) {
  for (const int k : rope.collapsed) {
    const TwistedState atoms = change(series.atoms, static_cast<std::size_t>(k)),
                       elements = change(series.elements, static_cast<std::size_t>(k));
    result.checks.push_back(relative_check(
        fmt::format("twisting energy of collapsed tubes, {:.4g} deg", atoms.angle * units::rad_in_degree),
        elements.total, atoms.total, 0.10, "eV"));
  }
}

// The same rope with Euler-Bernoulli bonds, as in the published model, shows the effect of shear.
void add_shear_information(const TwistedRope& rope, ParameterSet set, const Series& series, CaseResult& result) {
  set.bond.shear = 0;
  set.anharmonic.reset();
  const Series rigid{series.grips, series.atoms, twist_elements(rope, set, series.grips == "free"), 0};
  const auto last = static_cast<std::size_t>(rope.elastic_increments);
  for (const std::size_t k : std::array{last / 3, 2 * last / 3, last}) {
    const TwistedState atoms = change(rigid.atoms, k), elements = change(rigid.elements, k);
    result.checks.push_back(information(
        relative_check(fmt::format("twisting energy with bonds rigid in shear, grips {}, {:.4g} deg", series.grips,
                                   atoms.angle * units::rad_in_degree),
                       elements.total, atoms.total, 0.05, "eV", "the published kind of bond, for comparison")));
  }
}

// What the registry of real tubes, which the model leaves out, may move the twisting energy by: that of twelve
// pairs of neighbours at random.
void add_registry_information(const TwistedRope& rope, const ParameterSet& set, const Series& series,
                              CaseResult& result) {
  const double deviation = registry_deviation(set);
  if (deviation < 0) return;
  const auto last = static_cast<std::size_t>(rope.elastic_increments);
  for (const std::size_t k : std::array{last / 3, 2 * last / 3, last}) {
    const TwistedState atoms = change(series.atoms, k);
    result.checks.push_back(information(absolute_check(
        fmt::format("registry over twisting energy, grips {}, {:.4g} deg", series.grips,
                    atoms.angle * units::rad_in_degree),
        0, deviation * std::fabs(series.atoms[k].vdw) / std::sqrt(12.0) / atoms.total, 0, "1",
        fmt::format(
            "error bar of the twisting energy: {:.2g} % of the vdW energy a pair, of 12 pairs at random; the model "
            "has no registry",
            100 * deviation))));
  }
}

// Shortening is of second order in the angle, and softer in the atoms.
void add_axial_information(const TwistedRope& rope, const Series& series, CaseResult& result) {
  const auto k = static_cast<std::size_t>(rope.elastic_increments);
  const char* note =
      "shown only: rises with the square of the angle. Stretched tubes of atoms soften in tension and torsion, "
      "harmonic bonds do not";
  const auto add = [&](const std::string& name, double TwistedState::*value, const char* unit) {
    result.checks.push_back(information(
        relative_check(fmt::format("{}, {:.4g} deg", name, series.atoms[k].angle * units::rad_in_degree),
                       series.elements[k].*value - series.elements[0].*value,
                       series.atoms[k].*value - series.atoms[0].*value, 0.3, unit, note)));
  };
  if (series.grips == "fixed")
    add("tension due to the twist, grips fixed", &TwistedState::force, "eV/nm");
  else
    add("rise of the grip, grips free", &TwistedState::rise, "nm");
}

ChartLine points(const Series& s, std::vector<double> values) {
  return {"atoms, grips " + s.grips, degrees(s.atoms), std::move(values), s.colour, false, false, true};
}

ChartLine line(const Series& s, std::vector<double> values, const std::string& name = "elements") {
  return {name + ", grips " + s.grips, degrees(s.elements), std::move(values), s.colour, false, false, false};
}

CaseFigure comparison(const std::vector<Series>& all, double TwistedState::*value, bool against_start,
                      const std::string& quantity, const std::string& unit, const std::string& caption) {
  CaseFigure figure;
  figure.chart.title = quantity + " against the angle between the grips";
  figure.chart.x = {"angle between the grips", "deg"};
  figure.chart.y = {quantity, unit};
  for (const Series& s : all) {
    const double a = against_start ? s.atoms[0].*value : 0, e = against_start ? s.elements[0].*value : 0;
    figure.chart.lines.push_back(points(s, each(s.atoms, value, a)));
    figure.chart.lines.push_back(line(s, each(s.elements, value, e)));
  }
  figure.caption = caption;
  return figure;
}

CaseFigure residual_figure(const TwistedRope& rope, std::vector<Series> all) {
  CaseFigure figure;
  figure.chart.title = "Elements against atoms";
  figure.chart.x = {"angle between the grips", "deg"};
  figure.chart.y = {"elements over atoms", "%"};
  for (Series& s : all) {
    figure.chart.lines.push_back(line(s, residuals(s, &TwistedState::moment), "end moment"));
    figure.chart.lines.back().dashed = true;
    for (auto* states : {&s.atoms, &s.elements}) {
      const double start = (*states)[0].total;
      for (TwistedState& state : *states) state.total -= start;
    }
    figure.chart.lines.push_back(line(s, residuals(s, &TwistedState::total), "twisting energy"));
  }
  figure.caption = fmt::format(
      "Relative differences. The elastic range ends at {:.4g} degrees. At small angles the moment of atoms has a "
      "part due to registry that does not grow with the angle.",
      rope.elastic_increments * rope.step * units::rad_in_degree);
  return figure;
}

void add_figures(const TwistedRope& rope, const std::vector<Series>& all, CaseResult& result) {
  result.figures.push_back(comparison(all, &TwistedState::total, true, "twisting energy", "eV",
                                      "Total energy above that of the untwisted rope."));
  result.figures.push_back(residual_figure(rope, all));
  result.figures.push_back(
      comparison(all, &TwistedState::tubes, true, "energy inside of the tubes", "eV",
                 "Stretch, bending and torsion of the tubes make up nearly all of the twisting energy."));
  result.figures.push_back(
      comparison(all, &TwistedState::vdw, true, "change of the vdW energy", "eV",
                 "The energy between tubes, above that of the untwisted rope, is a small part."));
  result.figures.push_back(
      comparison(all, &TwistedState::moment, false, "end moment", "eV", "Moment on the upper grip."));
}

std::vector<std::string> remarks_of(const TwistedRope& rope) {
  std::vector<std::string> remarks = {
      "No stiffness was fitted to a rope. The clamped length follows from the rows of atoms; it was not adjusted.",
      "The bonds are anharmonic: stretched tubes soften in tension by about 4.5 % and in torsion by about 2 % per "
      "percent of strain, as in the periodic cells of the calibration. Harmonic bonds store up to 2.3 % too much "
      "in "
      "ropes of (5,5) and 13 % in one of (10,10) at 45 degrees.",
      "A short clamped tube shears where it bends. The shear stiffness of the bonds is that of a thin tube with "
      "the calibrated EA and GJ; it was not fitted. Bonds without shear are shown for comparison.",
      "The vdW energies differ by registry: relaxed atoms move into registry, smooth tubes have none. In both, the "
      "change of the vdW energy is below one percent of the twisting energy."};
  remarks.insert(remarks.end(), rope.remarks.begin(), rope.remarks.end());
  return remarks;
}

}  // namespace

TwistedRope rope_7_10_10() {
  TwistedRope rope;
  rope.name = "rope-7-10-10";
  rope.parameters = "cnt-10-10-tersoff";
  rope.free_rows = 64;
  rope.band_rows = 8;
  rope.bonds = 13;
  rope.step = 4.5 * units::degree;
  rope.increments = 6;
  rope.elastic_increments = 6;
  rope.remarks = {
      "A tube of six diameters that is clamped at both ends shears where it bends. Euler-Bernoulli bonds are 5 % "
      "too stiff from the smallest angle on; bonds with the shear stiffness of a thin tube agree within 0.3 % "
      "there.",
      "Beyond 27 degrees the walls collapse. The bond's torque is constant from there, at the twist at which a "
      "clamped tube of this length collapses; its energy is compared within 10 %.",
      "The vdW energy of atoms is 3 to 5 % deeper: wide tubes flatten where they touch, rigid cylinders do not."};
  return rope;
}

TwistedRope collapsed_rope_7_10_10() {
  TwistedRope rope = rope_7_10_10();
  rope.name = "rope-7-10-10-collapse";
  rope.step = 5 * units::degree;
  rope.increments = 12;
  rope.elastic_increments = 5;
  rope.collapsed = {9, 12};
  rope.axial_free = {false};
  return rope;
}

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

CaseResult run_twisted_rope(const TwistedRope& rope, const CaseContext& context) {
  CaseResult result;
  const ReferenceTable table = reference(
      context, rope.name, fresh_tolerance, [&] { return twist_atoms(rope, context); }, result);
  const ParameterSet model = context.model(rope.parameters);
  std::vector<Series> all;
  for (const bool axial_free : rope.axial_free) {
    const std::string grips = axial_free ? "free" : "fixed";
    if (context.progress) context.progress("elements: grips " + grips + " along the axis");
    all.push_back({grips, states_of(table, axial_free), twist_elements(rope, model, axial_free), axial_free});
    if (all.back().atoms.size() != all.back().elements.size())
      throw InputError({rope.name + ".csv", 0, ""}, "does not have the number of increments of the case",
                       "make the reference again with --fresh");
    add_checks(rope, all.back(), result);
    add_collapsed_checks(rope, all.back(), result);
    add_registry_information(rope, model, all.back(), result);
    add_axial_information(rope, all.back(), result);
    add_shear_information(rope, model, all.back(), result);
  }
  add_figures(rope, all, result);
  result.remarks = remarks_of(rope);
  result.sources.push_back(fmt::format("{} (hash {})", model.name, model.hash));
  return result;
}

Case twisted_rope_case(const TwistedRope& rope, const std::string& tube, const std::string& length) {
  Case c;
  c.name = rope.name;
  c.group = Case::Group::atoms;
  c.title = fmt::format("Twisted 7-tube rope of {}, {} nm", tube, length);
  c.why =
      "The program is made for this: torsion, bending, stretch and vdW contact at once. The stiffnesses were "
      "measured on single tubes; no number was fitted to a rope.";
  c.setup = fmt::format(
      "Seven {} tubes in hexagonal packing, {} nm between the clamps. Bands of 1 nm at both ends turn as rigid "
      "bodies by plus and minus half of the angle, at a fixed distance and, in a second series, free to approach "
      "each other. The angle grows in increments of {:.4g} degrees; the interior is relaxed after each. The checks "
      "lie in the elastic range, in which the torsional stiffness of a single tube stays within 1 % (r tau = "
      "0.04).",
      tube, length, rope.step * units::rad_in_degree);
  c.oracle =
      "LAMMPS: Tersoff potential within each tube, Lennard-Jones with the cutoff of the parameter set between "
      "tubes. The tubes are turned and shifted against each other so that all registries occur. The clamped "
      "length, the same for atoms and elements, reaches from the last held row of atoms of one band to the first "
      "of the other.";
  c.literature =
      "L. Lindsay, D. A. Broido, Phys. Rev. B 81, 205441 (2010), DOI 10.1103/PhysRevB.81.205441 (potential); A. P. "
      "Thompson et al., Comput. Phys. Commun. 271, 108171 (2022), DOI 10.1016/j.cpc.2021.108171 (LAMMPS)";
  c.run = [rope](const CaseContext& context) { return run_twisted_rope(rope, context); };
  return c;
}

}  // namespace ropewalk
