// A damped, twisted rope with the contact of the published code, which leaves out the torque of an angle.
#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "cases/common/gripped_rope.hpp"
#include "model/error.hpp"
#include "scene/lattice.hpp"
#include "sim/contact/paper/law.hpp"

namespace ropewalk::validate::rope_legacy_torque {
namespace {

constexpr int bonds = 30, records = 100;
constexpr double angle = 0.5 * units::pi;
constexpr double turning = 40, duration = 160;      // ps
constexpr double viscosity = 20, bond_damping = 1;  // eV ps/nm^2, 1/ps: the defaults of a scene

struct Record {
  std::vector<double> time, unaccounted, moment;                                 // ps, eV, eV
  double work = 0, stored = 0, twist = 0, vdw = 0, kinetic = 0, dissipated = 0;  // eV, at the end
  bool ended = false;                                                            // as planned
};

// damping: factor on the defaults of a scene.
Record twist(const ParameterSet& set, bool legacy, double damping) {
  GrippedRope rope(set, bonds, paper_law(*set.paper, legacy), pair_spacing(*set.paper, set.element_length));
  rope.interaction.damping.contact = {damping * viscosity, rope.spacing, 1.5 * rope.spacing};
  rope.interaction.damping.bond.rate = damping * bond_damping;
  const double half = 0.5 * angle, rate = half / turning;
  LoadsAndConstraints grips;
  grips.add(PrescribedRotation(rope.lower, -rate, -half, false));
  grips.add(PrescribedRotation(rope.upper, rate, half, false));
  const double step = default_step_fraction * time_step_limit(rope.topology, rope.interaction, rope.spacing).limit;
  Simulation s(rope.topology, rope.interaction, grips, rope.state, step);
  const Energies first = s.forces().energy;
  // The constraint accelerates the grips at the start; that work does not count.
  const double start = s.total_energy();
  Record r;
  try {
    const long steps = std::lround(duration / step), every = steps / records;
    for (long k = 1; k <= steps; ++k) {
      s.step();
      if (k % every != 0) continue;
      r.time.push_back(s.state().time);
      r.unaccounted.push_back(s.total_energy() - start - s.work() + s.dissipated());
      r.moment.push_back(resisting_moment(rope.upper, s.state().position, s.forces().force, s.forces().torque));
    }
    r.ended = true;
  } catch (const NumericalError&) {
    // After a blow-up the record before it counts.
  }
  const Energies& now = s.forces().energy;
  r.work = s.work();
  r.dissipated = s.dissipated();
  r.stored = now.potential() - first.potential();
  r.twist = now.twist - first.twist;
  r.vdw = now.vdw - first.vdw;
  r.kinetic = kinetic_energy(s.topology(), s.state());
  return r;
}

// --- Moment of the contact by virtual work ---

// Tubes wound around each other by `rate` (rad/nm). The contact depends only on position and axis.
State even_helix(const ParameterSet& set, int tubes, int elements, double rate) {
  const double spacing = pair_spacing(*set.paper, set.element_length);
  State state(static_cast<std::size_t>(tubes * elements));
  std::size_t i = 0;
  for (const auto& [x, y] : hexagonal_lattice(tubes, spacing))
    for (int e = 0; e < elements; ++e, ++i) {
      const double z = (e - 0.5 * (elements - 1)) * set.element_length;
      const Quaternion turn = turn_about(Vector3::UnitZ(), rate * z);
      state.position.set(i, turn * Vector3(x, y, z));
      state.orientation.set(i,
                            turn * Quaternion::FromTwoVectors(Vector3::UnitZ(), Vector3(-rate * y, rate * x, 1)));
    }
  return state;
}

struct ContactMoment {
  double by_forces = 0, by_energy = 0;  // eV
};

// Moment M by virtual work: when the rate grows by d(rate), forces and torques do the work -M L d(rate) and the
// energy grows by M L d(rate).
ContactMoment contact_moment(const ParameterSet& set, int tubes, double rate, bool legacy) {
  constexpr int elements = 40;
  constexpr double h = 1e-6;  // 1/nm
  Topology topology = topology_of(set);
  topology.types[0].bond = {};
  for (int t = 0; t < tubes; ++t) topology.add_tube(elements);
  Interaction interaction;
  interaction.law = paper_law(*set.paper, legacy);
  const auto forces = [&](const State& state) {
    return Simulation(topology, interaction, LoadsAndConstraints{}, state, units::fs).forces();
  };
  const State less = even_helix(set, tubes, elements, rate - h), more = even_helix(set, tubes, elements, rate + h);
  const Forces here = forces(even_helix(set, tubes, elements, rate));
  const double by = 2 * h * elements * set.element_length;
  ContactMoment moment;
  for (std::size_t i = 0; i < more.size(); ++i) {
    const Eigen::AngleAxisd turn(more.orientation[i] * less.orientation[i].conjugate());
    moment.by_forces -=
        (here.force[i].dot(more.position[i] - less.position[i]) + here.torque[i].dot(turn.angle() * turn.axis())) /
        by;
  }
  moment.by_energy = (forces(more).energy.vdw - forces(less).energy.vdw) / by;
  return moment;
}

// Moment that forces and torques lack, over the moment of the tubes' torsion.
double missing_moment(const ParameterSet& set, int tubes, double rate, bool legacy) {
  const ContactMoment moment = contact_moment(set, tubes, rate, legacy);
  return (moment.by_forces - moment.by_energy) / (tubes * set.bond.twist * rate);
}

CaseFigure size_figure(const ParameterSet& set, double rate, bool fault) {
  std::vector<double> size, full, legacy;
  for (const int tubes : {7, 19, 37, 61, 91}) {
    size.push_back(tubes);
    full.push_back(100 * missing_moment(set, tubes, rate, fault));
    legacy.push_back(100 * missing_moment(set, tubes, rate, true));
  }
  return case_figure(
      "Moment that the contact forces lack, against the size of the rope", {"tubes", "", true},
      {"missing moment over the torsion moment of the tubes", "%"},
      "Tubes wound evenly around each other by 0.01 rad/nm, at rest: neither damping nor a time step enters.",
      {theory_curve("derivative of the energy", 7, 91, [](double) { return 0.0; }),
       model_points("full gradient", size, full), model_points("without the torque", size, legacy, 2)});
}

double last(const std::vector<double>& values) {
  return values.empty() ? std::numeric_limits<double>::quiet_NaN() : values.back();
}

void add_full_checks(const Record& full, double torsion, CaseResult& result) {
  result.check_absolute("full gradient: error of the energy balance over the work",
                        last(full.unaccounted) / full.work, 0, 1e-3, "1",
                        "stored + kinetic + dissipated - work; the error of the time step");
  result.check_absolute("full gradient: kinetic energy at the end over the stored energy",
                        full.kinetic / full.stored, 0, 1e-4, "1", "the rope has come to rest");
  result.check_relative(
      "full gradient: torsion energy at rest", full.twist, torsion, 5e-3, "eV",
      "the clamped ends straighten the helix; this changes the energy by less than `1 - cos^2 beta`");
}

void add_legacy_information(const std::string& name, const Record& legacy, const Record& full, CaseResult& result) {
  const auto add = [&](const std::string& what, double value, double reference, double tolerance, bool relative) {
    result.show_relative(name + ": " + what, value, reference, tolerance, "eV");
    result.checks.back().relative = relative;
  };
  add("error of the energy balance at the end", last(legacy.unaccounted), 0, 1e-3 * full.work, false);
  add("kinetic energy at the end", legacy.kinetic, full.kinetic, 1e-4 * full.stored, false);
  add("dissipated", legacy.dissipated, full.dissipated, 0.05, true);
  add("work of the grips", legacy.work, full.work, 0.01, true);
  add("energy stored at the end", legacy.stored, full.stored, 0.01, true);
  add("change of the vdW energy", legacy.vdw, full.vdw, 1, false);
  add("end moment", last(legacy.moment), last(full.moment), 0.01, true);
}

CaseFigure record_figure(const std::string& title, const std::string& quantity,
                         const std::vector<double> Record::*value, const Record& full, const Record& legacy,
                         const Record& weak, const std::string& caption) {
  CaseFigure figure = case_figure(title, {"time", "ps"}, {quantity, "eV"}, caption);
  const auto line = [&](const std::string& name, const Record& r, int colour) {
    figure.chart.lines.push_back(model_points(name, r.time, r.*value, colour));
    figure.chart.lines.back().points = false;
  };
  line("full gradient", full, 1);
  line("no torque", legacy, 2);
  line("no torque, damping/10", weak, 3);
  return figure;
}

CaseResult run(const CaseContext& context) {
  const ParameterSet model = context.model(), oracle = context.set();
  const Record full = twist(model, context.fault.missing_torque, 1);
  const Record legacy = twist(model, true, 1), weak = twist(model, true, 0.1);
  const Record full_weak = twist(model, context.fault.missing_torque, 0.1);
  CaseResult result;
  add_full_checks(full,
                  torsion_energy(oracle.bond, pair_spacing(*oracle.paper, oracle.element_length),
                                 bonds * oracle.element_length, angle),
                  result);
  result.check_absolute("full gradient, a tenth of the damping: error of the energy balance over the work",
                        last(full_weak.unaccounted) / full_weak.work, 0, 1e-3, "1");
  add_legacy_information("without the torque", legacy, full, result);
  add_legacy_information("without the torque, a tenth of the damping", weak, full_weak, result);
  result.figures = {
      record_figure("Error of the energy balance of a twisted rope", "stored + kinetic + dissipated - work",
                    &Record::unaccounted, full, legacy, weak,
                    "Every change is an error, either of the time step or of forces that are not the gradient of "
                    "the energy."),
      record_figure("Moment on a grip of a rope that is twisted and held", "moment", &Record::moment, full, legacy,
                    weak, fmt::format("The grips turn for {:.0f} ps and are then held.", turning))};
  const double rate = 0.01;  // 1/nm: 5 degrees at the surface of 91 tubes
  const bool fault = context.fault.missing_torque;
  result.check_absolute(
      "full gradient: missing moment of the contact, 91 tubes, over the torsion moment",
      missing_moment(model, 91, rate, fault), 0, 1e-6, "1",
      "by virtual work of the forces against the derivative of the energy; difference quotient and rounding");
  for (const int tubes : {7, 91})
    result.show_absolute(
        fmt::format("without the torque: missing moment of the contact, {} tubes, over the torsion moment", tubes),
        missing_moment(model, tubes, rate, true), 0, 1e-2, "1", "evenly wound, 0.01 rad/nm");
  result.figures.push_back(size_figure(model, rate, fault));
  result.remarks.push_back(
      fmt::format("Without the torque the damped rope also comes to rest, at the same energy; its picture shows no "
                  "difference. But {:.3g} eV of the stored and dissipated energy were not supplied by any work, "
                  "and the moment on the grips is {:.2g} % too low. Weaker damping changes neither. Damping hides "
                  "the heating of an undamped bundle, but not this error.",
                  last(legacy.unaccounted), 100 * (1 - last(legacy.moment) / last(full.moment))));
  result.remarks.push_back(
      "The published code leaves out couples about the radial direction, all along tubes that are tilted against "
      "their neighbours. Evenly spread couples do not bend a tube; they act as tangential forces at the grips, and "
      "their moment grows with the distance from the axis. So the missing part of the moment hardly depends on the "
      "angle and grows with the size of the rope. Seven tubes show the smallest error.");
  return result;
}

const RegisteredCase registered([] {
  Case c;
  c.name = "rope-legacy-torque";
  c.group = Case::Group::codes;
  c.order = 60;
  c.tier = Case::Tier::full;
  c.law = Case::Law::paper;
  c.sets = {"cnt-10-10-paper"};
  c.only_these = "it shows what the published code does with the published set";
  c.title = "A twisted rope without the torque of the angle";
  c.why =
      "Ropes have been twisted with a contact code whose torques are not the gradient of its energy. What such "
      "results mean depends on how much of that error damping hides.";
  c.setup = fmt::format(
      "Seven {{tube}} tubes of {} bonds (41 nm) with the paper law between two grips. The grips turn against each "
      "other by 90 degrees in {:.0f} ps and are held until {:.0f} ps. Damping as in a scene by default (viscosity "
      "of contacts {:.0f} eV ps/nm², of bonds {:.0f}/ps), and a tenth of it; with the full gradient and without "
      "the torque.",
      bonds, turning, duration, viscosity, bond_damping);
  c.oracle =
      "Work = stored + kinetic + dissipated energy. The damped rope comes to rest. Torsion energy `GJ phi^2 (1 + 6 "
      "cos^2 beta)/(2 L)`, `tan beta = R0 phi/L`.";
  c.literature =
      "I. Ostanin, R. Ballarini, D. Potyondy, T. Dumitrica, J. Mech. Phys. Solids 61, 762 (2013), DOI "
      "10.1016/j.jmps.2012.10.016; public code: waLBerla, module MESA-PD";
  c.run = run;
  c.turns_red = {wrong_GJ(0.9), without_torque()};
  return c;
});

}  // namespace
}  // namespace ropewalk::validate::rope_legacy_torque
