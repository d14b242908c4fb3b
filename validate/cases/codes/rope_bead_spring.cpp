// A rope of bead-and-spring tubes against the same rope with directed elements: corrugation and missing torsion.
#include <algorithm>
#include <cmath>

#include "cases/common/bead_rope.hpp"
#include "cases/common/slide.hpp"
#include "scene/lattice.hpp"

namespace ropewalk {
namespace {

constexpr int bonds = 30, increments = 6;  // an even number, for Simpson's rule
constexpr double last_angle = 0.5 * units::pi;
constexpr double angle_step = last_angle / increments;

// --- Straight rope ---

// Energy per length (eV/nm) of seven long rows, each shifted along the rope by a part of an element.
template <class Law>
double rows_energy(const Law& law, double element_length, double spacing, const std::vector<double>& shift) {
  const auto lattice = hexagonal_lattice(GrippedRope::tubes, spacing);
  double sum = 0;
  for (std::size_t t = 0; t < lattice.size(); ++t)
    for (std::size_t u = t + 1; u < lattice.size(); ++u)
      for (int e = -30; e <= 30; ++e)
        sum += law.energy({lattice[u].first - lattice[t].first, lattice[u].second - lattice[t].second,
                           (e + shift[u] - shift[t]) * element_length},
                          Vector3::UnitZ(), Vector3::UnitZ());
  return sum / element_length;
}

// The centre tube slides by one element along the other six.
template <class Law>
Slide slide_centre(const Law& law, double element_length, double spacing) {
  Slide s;
  for (int k = 0; k <= 40; ++k) {
    std::vector<double> shift(GrippedRope::tubes, 0.0);
    shift[0] = k / 40.0;
    s.shift.push_back(shift[0]);
    s.energy.push_back(rows_energy(law, element_length, spacing, shift));
  }
  return s;
}

// Energy per length with tubes shifted by thirds of an element, minus that without shifts. Neighbours on a
// triangular lattice cannot all be half an element apart; with thirds all pairs are equal.
template <class Law>
double gained_by_staggering(const Law& law, double element_length, double spacing) {
  std::vector<double> shift(GrippedRope::tubes, 0.0);
  for (std::size_t t = 1; t < shift.size(); ++t) shift[t] = t % 2 ? 1.0 / 3 : 2.0 / 3;
  return rows_energy(law, element_length, spacing, shift) -
         rows_energy(law, element_length, spacing, std::vector<double>(GrippedRope::tubes, 0.0));
}

// --- Twisted rope ---

struct Twisted {
  std::vector<double> angle, energy, moment;         // degrees, eV above the straight rope, eV
  double stretch = 0, bend = 0, twist = 0, vdw = 0;  // at the last angle, of the energy
};

Twisted twist_elements(const ParameterSet& set) {
  GrippedRope rope(set, bonds, "line");
  rope.hold_grips();
  const double step = 0.9 * time_step_limit(rope.topology, rope.interaction, rope.spacing).limit;
  Twisted out;
  Energies straight;
  for (int k = 0; k <= increments; ++k) {
    if (k > 0) rope.turn(angle_step);
    const Simulation s =
        at_rest(Simulation(rope.topology, rope.interaction, rope.loads, rope.state, step), 1e-3, 100000);
    rope.state = s.state();
    const Energies& now = s.forces().energy;
    if (k == 0) straight = now;
    out.angle.push_back(k * angle_step * units::rad_in_degree);
    out.energy.push_back(now.potential() - straight.potential());
    out.moment.push_back(resisting_moment(rope.upper, rope.state.position, s.forces().force, s.forces().torque));
    out.stretch = now.stretch - straight.stretch;
    out.bend = now.bend + now.shear - straight.bend - straight.shear;
    out.twist = now.twist - straight.twist;
    out.vdw = now.vdw - straight.vdw;
  }
  return out;
}

Twisted twist_beads(const ParameterSet& set, const BeadLaw& law) {
  BeadRope rope(GrippedRope(set, bonds, "line"), law);
  rope.relax();
  const double stretch = rope.stretch(), bend = rope.bend(), vdw = rope.contact();
  Twisted out;
  for (int k = 0; k <= increments; ++k) {
    if (k > 0) rope.turn(angle_step);
    rope.relax();
    out.angle.push_back(k * angle_step * units::rad_in_degree);
    out.energy.push_back(rope.total() - stretch - bend - vdw);
    out.moment.push_back(rope.moment());
  }
  out.stretch = rope.stretch() - stretch;
  out.bend = rope.bend() - bend;
  out.vdw = rope.contact() - vdw;
  return out;
}

// --- Checks and figures ---

struct Straight {
  double element_length = 0, radius = 0;
  double well = 0;  // of the centre tube among its six neighbours, eV/nm
  Slide elements, beads;
  double beads_gain = 0, cohesion = 0;  // eV/nm of the rope
};

void add_straight_checks(const Straight& s, CaseResult& result) {
  constexpr double GPa = 1e-9 * units::electron_charge_C * 1e27;  // one eV/nm^3
  const double depth = std::fabs(s.well), circumference = 2 * units::pi * s.radius;
  result.checks.push_back(absolute_check("elements: corrugation over the well, centre tube slides",
                                         s.elements.corrugation() / depth, 0, 1e-3, "1",
                                         "registry of real tubes is 1e-2"));
  result.checks.push_back(information(absolute_check("beads: corrugation over the well, centre tube slides",
                                                     s.beads.corrugation() / depth, 0, 1e-3, "1",
                                                     "beads fall into the gaps of the other tubes")));
  // The amplitude c of a pair's cosine is half of the corrugation; shifts by thirds gain 3c/2.
  result.checks.push_back(information(
      relative_check("beads: energy gained by staggering, over the cohesion", s.beads_gain / s.cohesion,
                     0.75 * s.beads.corrugation() / depth, 0.05, "1",
                     "reference: 3/4 of the corrugation, for an energy that is a cosine of the shift")));
  result.checks.push_back(information(
      absolute_check("beads: barrier of one bead of the centre tube", s.beads.corrugation() * s.element_length, 0,
                     units::boltzmann * 300, "eV", "against the thermal energy at 300 K")));
  const auto strength = [&](const Slide& slide) {
    return 1e3 * GPa * slide.resistance(s.element_length) / circumference;
  };
  result.checks.push_back(information(absolute_check(
      "beads: shear strength against sliding of the centre tube", strength(s.beads), strength(s.elements), 1, "MPa",
      "reference: the elements. All beads of the tube resist at once; force over the tube's surface")));
}

void add_twist_checks(const Twisted& elements, const Twisted& beads, double torsion, CaseResult& result) {
  const double angle = angle_step;
  result.checks.push_back(relative_check(
      "elements: torsion energy at 90 degrees", elements.twist, torsion, 5e-3, "eV",
      "the clamped ends straighten the helix; this changes the energy by less than 1 - cos^2(beta)"));
  result.checks.push_back(relative_check("elements: work of the grips up to 90 degrees",
                                         simpson_sum(elements.moment, angle), elements.energy.back(), 1e-3, "eV",
                                         "stored energy; Simpson's rule over six increments"));
  result.checks.push_back(information(relative_check(
      "beads: work of the grips up to 90 degrees", simpson_sum(beads.moment, angle), beads.energy.back(), 1e-3,
      "eV", "shows that the beads are conservative: the energy that they lack is not a numerical error")));
  result.checks.push_back(information(relative_check("beads: twisting energy at 90 degrees", beads.energy.back(),
                                                     elements.energy.back(), 0.05, "eV")));
  result.checks.push_back(information(
      relative_check("beads: end moment at 90 degrees", beads.moment.back(), elements.moment.back(), 0.05, "eV")));
  result.checks.push_back(information(absolute_check("elements: torsion energy over the twisting energy",
                                                     elements.twist / elements.energy.back(), 1, 0.1, "1")));
  result.checks.push_back(information(relative_check("beads: bending energy", beads.bend, elements.bend, 0.1, "eV",
                                                     "the clamped ends differ only by the shear of a bond")));
  result.checks.push_back(information(
      relative_check("beads: stretching energy", beads.stretch, elements.stretch, 0.1, "eV", "the same helix")));
  result.checks.push_back(information(absolute_check("beads: change of the vdW energy", beads.vdw, elements.vdw,
                                                     0.01 * elements.energy.back(), "eV")));
}

CaseFigure slide_figure(const Straight& s) {
  CaseFigure figure;
  figure.chart = {"Energy of a rope whose centre tube slides along the other six",
                  {"shift", "elements"},
                  {"energy from its mean, of the well", "%"},
                  {},
                  {}};
  figure.chart.lines.push_back(theory_curve(
      "smooth tubes", [](double) { return 0.0; }, 0, 1));
  figure.chart.lines.push_back(model_points("beads", s.beads.shift, s.beads.relative(s.well), 2));
  figure.chart.lines.push_back(model_points("elements", s.elements.shift, s.elements.relative(s.well), 1));
  figure.caption = "Six rows of beads keep the seventh in step. A real tube is smooth along its axis.";
  return figure;
}

// How close beads would have to be, at the same spacing and cohesion of the tubes.
CaseFigure spacing_figure(const Well& pair) {
  std::vector<double> length, corrugation;
  for (int k = 4; k <= 20; ++k) {
    length.push_back(0.1 * k);
    const BeadLaw law(pair.distance, pair.energy, length.back());
    const Slide s = slide_centre(law, length.back(), pair.distance);
    corrugation.push_back(std::log10(std::max(s.corrugation() / (6 * std::fabs(pair.energy)), 1e-12)));
  }
  CaseFigure figure;
  figure.chart = {"Corrugation against the distance of beads",
                  {"distance of beads along a tube", "nm"},
                  {"log10 of the corrugation over the well", ""},
                  {},
                  {}};
  figure.chart.lines.push_back(theory_curve(
      "registry of real tubes", [](double) { return -2.0; }, 0.4, 2));
  figure.chart.lines.push_back(model_points("beads", length, corrugation, 2));
  figure.caption =
      "A bead law is as smooth as real tubes only if the beads are closer than half the distance of the tubes. The "
      "number of pairs grows with the square of the beads per length, and the time step falls.";
  return figure;
}

CaseFigure twist_figure(const std::string& title, const std::string& quantity, const Twisted& elements,
                        const Twisted& beads, const std::vector<double> Twisted::*value,
                        const std::function<double(double)>& torsion, const std::string& caption) {
  CaseFigure figure;
  figure.chart = {title, {"angle between the grips", "deg"}, {quantity, "eV"}, {}, {}};
  figure.chart.lines.push_back(theory_curve("torsion of the tubes", torsion, 0, last_angle * units::rad_in_degree));
  figure.chart.lines.push_back(model_points("elements", elements.angle, elements.*value, 1));
  figure.chart.lines.push_back(model_points("beads", beads.angle, beads.*value, 2));
  figure.caption = caption;
  return figure;
}

Straight straight_rope(const ParameterSet& model, const Well& pair, const BeadLaw& bead) {
  const double a = model.element_length;
  const LineContact line = line_contact_of(model);
  Straight s;
  s.element_length = a;
  s.radius = model.radius;
  s.well = 6 * pair.energy;
  s.elements = slide_centre(line, a, pair.distance);
  s.beads = slide_centre(bead, a, pair.distance);
  s.beads_gain = gained_by_staggering(bead, a, pair.distance);
  s.cohesion = 12 * pair.energy;
  return s;
}

CaseResult run(const CaseContext& context) {
  const ParameterSet model = context.model(), oracle = context.set();
  const Well pair = surface_integral(oracle).parallel_well();
  const BeadLaw bead(pair.distance, pair.energy, oracle.element_length);
  const double length = bonds * oracle.element_length;
  CaseResult result;
  const Straight straight = straight_rope(model, pair, bead);
  result.checks.push_back(relative_check("elements: cohesion of the straight rope", straight.elements.mean(),
                                         straight.cohesion, 3e-3, "eV/nm",
                                         "twelve pairs; contact fitted to 1.4e-3 of the well"));
  add_straight_checks(straight, result);
  context.progress("twisting the rope of elements");
  const Twisted elements = twist_elements(model);
  context.progress("twisting the rope of beads");
  const Twisted beads = twist_beads(oracle, bead);
  add_twist_checks(elements, beads, torsion_energy(oracle.bond, pair.distance, length, last_angle), result);
  const auto energy = [&](double degrees) {
    return torsion_energy(oracle.bond, pair.distance, length, degrees * units::degree);
  };
  const auto moment = [&](double degrees) {
    constexpr double h = 0.01;
    return (energy(degrees + h) - energy(degrees - h)) / (2 * h * units::degree);
  };
  result.figures = {
      slide_figure(straight), spacing_figure(pair),
      twist_figure("Energy of the twisted rope", "energy above the straight rope", elements, beads,
                   &Twisted::energy, energy,
                   "The beads lack the torsion of the tubes, which is nearly all of the energy."),
      twist_figure("Moment on a grip of the twisted rope", "moment", elements, beads, &Twisted::moment, moment,
                   "A rope of beads resists a twist only by bending and stretching its outer tubes.")};
  result.remarks.push_back(
      "The beads have the spacing and the mean cohesion of the oracle and the EA and EI of the set. The only "
      "difference is that a bead has no direction. A tube of beads turns about its own axis at no cost, and the "
      "grips work only against bent and stretched outer tubes. A bead model fitted to the moment would have to "
      "replace torsion by one of these.");
  result.remarks.push_back(
      "The corrugation has the opposite effect: it resists sliding, with all beads of a tube at once. In real "
      "tubes the corrugation by registry is 1 to 3 % of the well and not in step along the tube. The two errors do "
      "not cancel: one lets the rope twist too easily, the other keeps its tubes from sliding.");
  result.remarks.push_back(
      "Three neighbours cannot all be half an element apart. With a cosine of amplitude c per pair, shifts of a "
      "third of an element are best and gain 3c/2. Beads side by side, as in a rope cut straight, are the state of "
      "highest energy; only the stretch of the tubes between two grips keeps them there.");
  result.sources.push_back(context.tube().source);
  return result;
}

const RegisteredCase registered([] {
  Case c;
  c.name = "rope-bead-spring";
  c.group = Case::Group::codes;
  c.order = 40;
  c.tier = Case::Tier::full;
  c.title = "A twisted rope of beads and springs";
  c.why =
      "Stock molecular dynamics codes build tubes from beads and springs. A twisted rope stores most of its energy "
      "in torsion, which beads do not have.";
  c.setup =
      "Seven {tube} tubes of 30 bonds between two grips at a fixed distance. The grips turn against each "
      "other by 90 degrees in increments of 15; the rope is relaxed after each. Once with elements and the line "
      "law, once with a bead in the place of each element: the same EA and EI, no torsion, a 12-6 contact of the "
      "same spacing and cohesion. Also the straight rope, with its centre tube shifted by up to one element, and "
      "with its tubes shifted by thirds of an element.";
  c.oracle =
      "Smooth cylinders: the energy does not depend on the shift, and the cohesion is that of twelve pairs by the "
      "surface integral. Torsion energy GJ phi^2 (1 + 6 cos^2 beta)/(2 L), tan beta = R0 phi/L. The stored energy "
      "is the integral of M dphi.";
  c.literature =
      "M. J. Buehler, J. Mater. Res. 21, 2855 (2006), DOI 10.1557/jmr.2006.0347; A. E. H. Love, A Treatise on the "
      "Mathematical Theory of Elasticity, 4th ed. (1927)";
  c.run = run;
  c.turns_red = {wrong_GJ(0.9), wrong_contact(2)};
  return c;
});

}  // namespace
}  // namespace ropewalk
