// A rope of bead-and-spring tubes against the same rope with directed elements: corrugation and missing torsion.
#include <algorithm>
#include <cmath>

#include "cases/common/bead_law.hpp"
#include "cases/common/gripped_rope.hpp"
#include "cases/common/slide.hpp"
#include "scene/lattice.hpp"
#include "sim/contact/line/law.hpp"

namespace ropewalk::validate::rope_bead_spring {
namespace {

constexpr int bonds = 30, increments = 6;  // an even number, for Simpson's rule
constexpr double last_angle = 0.5 * units::pi;
constexpr double angle_step = last_angle / increments;

// --- Straight rope ---

Places rows_at(double spacing) { return hexagonal_lattice(GrippedRope::tubes, spacing); }

// Energy per length with tubes shifted by thirds of an element, minus that without shifts. Neighbours on a
// triangular lattice cannot all be half an element apart; with thirds all pairs are equal.
double gained_by_staggering(const ContactLaw& law, double element_length, double spacing) {
  std::vector<double> shift(GrippedRope::tubes, 0.0);
  const double straight = rows_energy(law, element_length, rows_at(spacing), shift);
  for (std::size_t t = 1; t < shift.size(); ++t) shift[t] = t % 2 ? 1.0 / 3 : 2.0 / 3;
  return rows_energy(law, element_length, rows_at(spacing), shift) - straight;
}

// --- Twisted rope ---

struct Twisted {
  std::vector<double> angle, energy, moment;         // degrees, eV above the straight rope, eV
  double stretch = 0, bend = 0, twist = 0, vdw = 0;  // at the last angle, of the energy
};

Twisted twisted(GrippedRope rope, double tolerance) {
  Twisted out;
  Energies straight;
  for (int k = 0; k <= increments; ++k) {
    if (k > 0) rope.turn(angle_step);
    rope.relax(tolerance);
    const Energies& now = rope.forces.energy;
    if (k == 0) straight = now;
    out.angle.push_back(k * angle_step * units::rad_in_degree);
    out.energy.push_back(now.potential() - straight.potential());
    out.moment.push_back(rope.moment());
    out.stretch = now.stretch - straight.stretch;
    out.bend = now.bend + now.shear - straight.bend - straight.shear;
    out.twist = now.twist - straight.twist;
    out.vdw = now.vdw - straight.vdw;
  }
  return out;
}

// A tube of beads: elements that neither twist nor shear, so that only the places of their centres count, also in
// the grips.
GrippedRope rope_of_beads(ParameterSet set, const Well& pair) {
  const auto law = std::make_shared<const BeadLaw>(pair.distance, pair.energy, set.element_length, 4);
  set.bond.twist = set.bond.shear = 0;
  GrippedRope rope(set, bonds, law, line_parallel_well(set.line->density).distance);
  rope.holds_orientations = false;
  return rope;
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
  result.check_absolute("elements: corrugation over the well, centre tube slides", s.elements.corrugation() / depth,
                        0, 1e-3, "1", "registry of real tubes is 1e-2");
  result.show_absolute("beads: corrugation over the well, centre tube slides", s.beads.corrugation() / depth, 0,
                       1e-3, "1", "beads fall into the gaps of the other tubes");
  // The amplitude c of a pair's cosine is half of the corrugation; shifts by thirds gain 3c/2.
  result.show_relative("beads: energy gained by staggering, over the cohesion", s.beads_gain / s.cohesion,
                       0.75 * s.beads.corrugation() / depth, 0.05, "1",
                       "reference: 3/4 of the corrugation, for an energy that is a cosine of the shift");
  result.show_absolute("beads: barrier of one bead of the centre tube", s.beads.corrugation() * s.element_length, 0,
                       units::boltzmann * 300, "eV", "against the thermal energy at 300 K");
  const auto strength = [&](const Slide& slide) {
    return 1e3 * GPa * slide.resistance(s.element_length) / circumference;
  };
  result.show_absolute(
      "beads: shear strength against sliding of the centre tube", strength(s.beads), strength(s.elements), 1, "MPa",
      "reference: the elements. All beads of the tube resist at once; force over the tube's surface");
}

void add_twist_checks(const Twisted& elements, const Twisted& beads, double torsion, CaseResult& result) {
  const double angle = angle_step;
  result.check_relative(
      "elements: torsion energy at 90 degrees", elements.twist, torsion, 5e-3, "eV",
      "the clamped ends straighten the helix; this changes the energy by less than `1 - cos^2 beta`");
  result.check_relative("elements: work of the grips up to 90 degrees", simpson_sum(elements.moment, angle),
                        elements.energy.back(), 1e-3, "eV", "stored energy; Simpson's rule over six increments");
  result.show_relative("beads: work of the grips up to 90 degrees", simpson_sum(beads.moment, angle),
                       beads.energy.back(), 1e-3, "eV",
                       "shows that the beads are conservative: the energy that they lack is not a numerical error");
  result.show_relative("beads: twisting energy at 90 degrees", beads.energy.back(), elements.energy.back(), 0.05,
                       "eV");
  result.show_relative("beads: end moment at 90 degrees", beads.moment.back(), elements.moment.back(), 0.05, "eV");
  result.show_absolute("elements: torsion energy over the twisting energy", elements.twist / elements.energy.back(),
                       1, 0.1, "1");
  result.show_relative("beads: bending energy", beads.bend, elements.bend, 0.1, "eV",
                       "the clamped ends differ only by the shear of a bond");
  result.show_relative("beads: stretching energy", beads.stretch, elements.stretch, 0.1, "eV", "the same helix");
  result.show_absolute("beads: change of the vdW energy", beads.vdw, elements.vdw, 0.01 * elements.energy.back(),
                       "eV");
}

CaseFigure slide_figure(const Straight& s) {
  return case_figure("Energy of a rope whose centre tube slides along the other six", {"shift", "elements"},
                     {"energy from its mean, of the well", "%"},
                     "Six rows of beads keep the seventh in step. A real tube is smooth along its axis.",
                     {theory_curve("smooth tubes", 0, 1, [](double) { return 0.0; }),
                      model_points("beads", s.beads.shift, s.beads.relative(s.well), 2),
                      model_points("elements", s.elements.shift, s.elements.relative(s.well))});
}

// How close beads would have to be, at the same spacing and cohesion of the tubes.
CaseFigure spacing_figure(const Well& pair) {
  std::vector<double> length, corrugation;
  for (int k = 4; k <= 20; ++k) {
    length.push_back(0.1 * k);
    const BeadLaw law(pair.distance, pair.energy, length.back(), BeadLaw::uncut);
    const Slide s = slide_first(law, length.back(), rows_at(pair.distance));
    corrugation.push_back(std::max(s.corrugation() / (6 * std::fabs(pair.energy)), 1e-12));
  }
  return case_figure(
      "Corrugation against the distance of beads", {"distance of beads along a tube", "nm"},
      {"corrugation over the well", "", false, true},
      "A bead law is as smooth as real tubes only if the beads are closer than half the distance of the tubes. The "
      "number of pairs grows with the square of the beads per length, and the time step falls.",
      {theory_curve("registry of real tubes", 0.4, 2, [](double) { return 1e-2; }),
       model_points("beads", length, corrugation, 2)});
}

CaseFigure twist_figure(const std::string& title, const std::string& quantity, const Twisted& elements,
                        const Twisted& beads, const std::vector<double> Twisted::*value,
                        const std::function<double(double)>& torsion, const std::string& caption) {
  return case_figure(title, {"angle between the grips", "deg"}, {quantity, "eV"}, caption,
                     {theory_curve("torsion of the tubes", 0, last_angle * units::rad_in_degree, torsion),
                      model_points("elements", elements.angle, elements.*value),
                      model_points("beads", beads.angle, beads.*value, 2)});
}

Straight straight_rope(const ParameterSet& model, const PairIntegral& integral, const Well& pair,
                       const BeadLaw& bead) {
  const double a = model.element_length;
  Straight s;
  s.element_length = a;
  s.radius = model.radius;
  s.well = 6 * pair.energy;
  s.elements = slide_first(LineLaw({line_contact_of(model)}), a, rows_at(pair.distance));
  s.beads = slide_first(bead, a, rows_at(pair.distance));
  s.beads_gain = gained_by_staggering(bead, a, pair.distance);
  s.cohesion = rope_energy(integral, GrippedRope::tubes, pair.distance);
  return s;
}

CaseResult run(const CaseContext& context) {
  const ParameterSet model = context.model(), oracle = context.set();
  const PairIntegral integral = surface_integral(oracle);
  const Well pair = integral.parallel_well();
  const BeadLaw bead(pair.distance, pair.energy, oracle.element_length, BeadLaw::uncut);
  const double length = bonds * oracle.element_length;
  CaseResult result;
  const Straight straight = straight_rope(model, integral, pair, bead);
  result.check_relative("elements: cohesion of the straight rope", straight.elements.mean(), straight.cohesion,
                        3e-3, "eV/nm", "all pairs of tubes; contact fitted to 1.4e-3 of the well");
  add_straight_checks(straight, result);
  context.progress("twisting the rope of elements");
  const Twisted elements = twisted(gripped_rope(model, bonds), 1e-3);
  context.progress("twisting the rope of beads");
  const Twisted beads = twisted(rope_of_beads(oracle, pair), 1e-4);
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
      "The beads have the spacing and the mean cohesion of the oracle and the `EA` and `EI` of the set. The only "
      "difference is that a bead has no direction. A tube of beads turns about its own axis at no cost, and the "
      "grips work only against bent and stretched outer tubes. A bead model fitted to the moment would have to "
      "replace torsion by one of these.");
  result.remarks.push_back(
      "Grips of beads hold places alone. A chain of hinges between bonds leaves such a grip as if it were clamped "
      "half a bond inside; the bonds here bend within the grip as well, which makes it a third. Energy, moment and "
      "bending are 3 % above those of hinges therefore, a third of what grips that hold orientations would add.");
  result.remarks.push_back(
      "The corrugation has the opposite effect: it resists sliding, with all beads of a tube at once. In real "
      "tubes the corrugation by registry is 1 to 3 % of the well and not in step along the tube. The two errors do "
      "not cancel: one lets the rope twist too easily, the other keeps its tubes from sliding.");
  result.remarks.push_back(
      "Three neighbours cannot all be half an element apart. With a cosine of amplitude `c` per pair, shifts of a "
      "third of an element are best and gain `3c/2`. Beads side by side, as in a rope cut straight, are the state "
      "of highest energy; only the stretch of the tubes between two grips keeps them there.");
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
      "Seven {tube} tubes of 30 bonds between two grips at a fixed distance. The grips turn against each other by "
      "90 degrees in increments of 15; the rope is relaxed after each. Once with elements and the line law, once "
      "with a bead in the place of each element: the same `EA` and `EI`, no torsion, a 12-6 contact of the same "
      "spacing and cohesion. Also the straight rope, with its centre tube shifted by up to one element, and with "
      "its tubes shifted by thirds of an element.";
  c.oracle =
      "Smooth cylinders: the energy does not depend on the shift, and the cohesion is that of all pairs of tubes "
      "by the surface integral. Torsion energy `GJ phi^2 (1 + 6 cos^2 beta)/(2 L)`, `tan beta = R0 phi/L`. The "
      "stored energy is the integral of `M dphi`.";
  c.literature =
      "M. J. Buehler, J. Mater. Res. 21, 2855 (2006), DOI 10.1557/jmr.2006.0347; A. E. H. Love, A Treatise on the "
      "Mathematical Theory of Elasticity, 4th ed. (1927)";
  c.run = run;
  c.turns_red = {wrong_GJ(0.9), wrong_contact(2)};
  return c;
});

}  // namespace
}  // namespace ropewalk::validate::rope_bead_spring
