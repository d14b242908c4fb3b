// A whole rope with incremental parallel bonds, led around closed loops.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "cases/common/driven_rope.hpp"

namespace ropewalk {
namespace {

constexpr const char* set_name = "cnt-10-10-tersoff";
constexpr int bonds = 12, rounds = 2;
constexpr double angle = 48 * units::degree, shift = 2;  // nm
constexpr double brake = 1.5;                            // 1/ps: near aperiodic for the slowest bending mode
constexpr double leg = 8, settle = 15;                   // ps
constexpr double step_fraction = 0.5;           // of the limit of total-energy bonds; incremental ones bear less
constexpr double temperature = 300, warm = 20;  // K, ps

using Bonds = LedRope::Bonds;

// Starts and ends at no speed.
double eased(double part) { return part * part * (3 - 2 * part); }
// Of a part of a path, the part of its k-th of n legs.
double leg_part(double part, int k, int n) { return eased(std::min(std::max(n * part - k, 0.0), 1.0)); }

struct Loop {
  std::string name;
  int legs = 0;
  GripPlace (*at)(double part) = nullptr;
};

GripPlace there_and_back(double part) { return {angle * (leg_part(part, 0, 2) - leg_part(part, 1, 2)), {0, 0, 0}}; }

GripPlace twisted_and_shifted(double part) {
  return {angle * (leg_part(part, 0, 4) - leg_part(part, 2, 4)),
          {shift * (leg_part(part, 1, 4) - leg_part(part, 3, 4)), 0, 0}};
}

const Loop back{"twisted and back", 2, there_and_back};
const Loop square{"twisted, shifted, twisted back, shifted back", 4, twisted_and_shifted};

// At rest, with the grips where they were built.
LedRope settled(const ParameterSet& set, Bonds kind, double fraction = step_fraction) {
  LedRope rope(set, bonds, kind, fraction, brake);
  rope.rest(settle);
  return rope;
}

struct Left {
  double energy = 0, moment = 0;  // eV
};

Left left_in(const LedRope& rope, const LedRope& start) {
  return {rope.energy() - start.energy(), rope.moment() - start.moment()};
}

Left lead_around(const LedRope& start, const Loop& loop, double leg_duration) {
  LedRope rope = start;
  rope.lead(loop.at, loop.legs * leg_duration);
  rope.rest(settle);
  return left_in(rope, start);
}

// Warmed and cooled again, with the grips held; after 0, 1, .. rounds of it.
std::vector<Left> shake(const LedRope& start) {
  LedRope rope = start;
  std::vector<Left> left{{}};
  for (int k = 1; k <= rounds; ++k) {
    rope.shake(temperature, static_cast<std::uint64_t>(k), warm);
    rope.rest(settle);
    left.push_back(left_in(rope, start));
  }
  return left;
}

struct Twisted {
  double energy = 0, twist = 0, moment = 0;  // eV
};

Twisted twisted(const LedRope& start) {
  LedRope rope = start;
  rope.lead([](double part) { return GripPlace{angle * eased(part), {0, 0, 0}}; }, leg);
  rope.rest(settle);
  return {rope.energy() - start.energy(), rope.twist(), rope.moment()};
}

constexpr double returns = 1e-4;         // eV: far below the heat of one degree of freedom at 300 K, 1.3e-2
constexpr double moment_returns = 1e-2;  // eV: 1e-5 of the twisting moment

void add_return_checks(const std::string& path, const Left& left, CaseResult& result) {
  result.checks.push_back(absolute_check("total energy: energy left, " + path, left.energy, 0, returns, "eV",
                                         "a function of the state; what has not come to rest"));
  result.checks.push_back(
      absolute_check("total energy: moment left, " + path, left.moment, 0, moment_returns, "eV"));
}

void add_residue(const std::string& path, const Left& left, CaseResult& result, const std::string& note = "") {
  result.checks.push_back(
      information(absolute_check("incremental: energy left, " + path, left.energy, 0, returns, "eV", note)));
  result.checks.push_back(
      information(absolute_check("incremental: moment left, " + path, left.moment, 0, moment_returns, "eV")));
}

// The same rope at rest: with our bonds, with incremental ones, and with these at half the time step.
struct Ropes {
  LedRope total, coarse, fine;
};

void add_twist_checks(const Ropes& ropes, const ParameterSet& oracle, CaseResult& result) {
  const Twisted ours = twisted(ropes.total), theirs = twisted(ropes.coarse);
  const double spacing = line_parallel_well(oracle.line->density).distance;
  result.checks.push_back(relative_check("total energy: torsion of the twisted rope", ours.twist,
                                         torsion_energy(oracle.bond, spacing, bonds * oracle.element_length, angle),
                                         1e-2, "eV",
                                         "1 - cos^2(beta), by which the clamped ends straighten the helix"));
  result.checks.push_back(information(relative_check("incremental: energy of the twisted rope", theirs.energy,
                                                     ours.energy, 1e-2, "eV", "twisted once: the same rope")));
  result.checks.push_back(information(
      relative_check("incremental: moment of the twisted rope", theirs.moment, ours.moment, 1e-2, "eV")));
}

// Each value at twice the duration of the one before.
double at_no_speed(const std::vector<double>& energy) {
  const std::size_t n = energy.size();
  return (4 * energy[n - 1] - energy[n - 2]) / 3;
}

void add_loop_checks(const Ropes& ropes, CaseResult& result) {
  std::vector<double> duration, by_back, by_square, energy_back, energy_square;
  for (const double slower : {1.0, 2.0, 4.0}) {
    duration.push_back(slower * leg);
    const auto legs = fmt::format(", legs of {:.0f} ps", duration.back());
    const Left b = lead_around(ropes.coarse, back, duration.back());
    const Left s = lead_around(ropes.coarse, square, duration.back());
    add_residue(back.name + legs, b, result, "falls with the square of the speed: inertia takes it off its path");
    add_residue(square.name + legs, s, result);
    energy_back.push_back(b.energy);
    energy_square.push_back(s.energy);
    by_back.push_back(1e3 * b.energy);
    by_square.push_back(1e3 * s.energy);
  }
  for (const auto& [name, energy] : {std::pair(back.name, energy_back), std::pair(square.name, energy_square)})
    result.checks.push_back(information(
        absolute_check("incremental: energy left without speed, " + name, at_no_speed(energy), 0, returns, "eV",
                       "from the two slowest: the rest goes with the square of the speed")));
  add_residue(fmt::format("{}, legs of {:.0f} ps, half the time step", square.name, leg),
              lead_around(ropes.fine, square, leg), result);
  add_return_checks(back.name, lead_around(ropes.total, back, leg), result);
  add_return_checks(square.name, lead_around(ropes.total, square, leg), result);
  CaseFigure figure;
  figure.chart = {"Energy left by incremental bonds after one closed loop of a grip",
                  {"duration of a leg", "ps"},
                  {"energy", "meV"},
                  {},
                  {}};
  figure.chart.lines.push_back(theory_curve(
      "a function of the state", [](double) { return 0.0; }, 0, duration.back()));
  figure.chart.lines.push_back(model_points("twisted and back", duration, by_back, 3));
  figure.chart.lines.push_back(model_points("and shifted between", duration, by_square, 2));
  figure.caption =
      "Incremental bonds; the grip is back and all is at rest. A slow path that runs back into itself leaves "
      "nothing; one that goes "
      "around leaves something, however slow.";
  result.figures.push_back(figure);
}

ChartLine heat_line(const std::string& name, const std::vector<Left>& left, int colour) {
  std::vector<double> time, energy;
  for (std::size_t k = 0; k < left.size(); ++k) {
    time.push_back(static_cast<double>(k) * warm);
    energy.push_back(left[k].energy);
  }
  return model_points(name, time, energy, colour);
}

void add_heat_checks(const Ropes& ropes, CaseResult& result) {
  const std::vector<Left> total = shake(ropes.total), coarse = shake(ropes.coarse), fine = shake(ropes.fine);
  const std::string path = fmt::format("{:.0f} ps at {:.0f} K", rounds * warm, temperature);
  add_return_checks(path, total.back(), result);
  add_residue(path, coarse.back(), result, "the walk of a sum of small rotations");
  add_residue(path + ", half the time step", fine.back(), result);
  CaseFigure figure;
  figure.chart = {
      "Energy left in a rope at rest that has been warm", {"time at 300 K", "ps"}, {"energy", "eV"}, {}, {}};
  figure.chart.lines.push_back(theory_curve(
      "a function of the state", [](double) { return 0.0; }, 0, rounds * warm));
  figure.chart.lines.push_back(heat_line("total energy", total, 1));
  figure.chart.lines.push_back(heat_line("incremental", coarse, 2));
  figure.chart.lines.push_back(heat_line("incremental, step/2", fine, 3));
  figure.caption =
      "Held, warmed and cooled: elements are back to rest, but incremental bonds have forgotten where.";
  result.figures.push_back(figure);
}

CaseResult run(const CaseContext& context) {
  const ParameterSet model = context.model(set_name);
  const Ropes ropes{settled(model, Bonds::total_energy), settled(model, Bonds::incremental),
                    settled(model, Bonds::incremental, 0.5 * step_fraction)};
  CaseResult result;
  add_twist_checks(ropes, context.parameters(set_name), result);
  context.progress("around closed loops");
  add_loop_checks(ropes, result);
  context.progress("warm and cooled");
  add_heat_checks(ropes, result);
  result.remarks.push_back(
      "Twisted once, a rope of incremental bonds is the same rope. What it keeps of a closed loop has two sources. "
      "A "
      "path that runs back into itself leaves only what inertia takes it off that path, which vanishes with the "
      "speed; one that encloses an area of bend and twist leaves a rest at any speed, small at the angles of one "
      "bond "
      "that a tube allows.");
  result.remarks.push_back(
      "Heat is the worse of the two: elements tremble through thousands of small loops, and each step adds an "
      "error "
      "of the second order of its rotations. The rest angles of the bonds walk away, and the rope stores energy "
      "that "
      "no load has put there. Smaller steps leave less of it, not nothing. With total-energy bonds there is "
      "nothing "
      "to accumulate, at any step.");
  result.sources.push_back(set_name);
  return result;
}

}  // namespace

Case rope_parallel_bond_case() {
  Case c;
  c.name = "rope-parallel-bond";
  c.group = Case::Group::codes;
  c.title = "A rope with incremental parallel bonds";
  c.why =
      "A rope that is loaded, unloaded and loaded again must come back to the same state; bonds that remember the "
      "path leave a moment in it that no load explains.";
  c.setup = fmt::format(
      "Seven (10,10) tubes of {} bonds (16.5 nm) between two grips, with the line law between them, in damped "
      "motion "
      "with a time step of {} of the stability limit. One grip is led around closed loops: twisted by {:.0f} "
      "degrees "
      "and back; twisted, shifted sideways by {:.0f} nm, twisted back, shifted back; each leg in {:.0f} ps and "
      "more. "
      "And with the grips held, {} times {:.0f} ps without damping at {:.0f} K. After each of it everything comes "
      "to "
      "rest. All with total-energy bonds and with incremental ones.",
      bonds, step_fraction, angle * units::rad_in_degree, shift, leg, rounds, warm, temperature);
  c.oracle =
      "Energy and moment are functions of the state: none is left when the grips are back. Torsion energy of the "
      "twisted rope GJ phi^2 (1 + 6 cos^2 beta)/2L, tan beta = R0 phi/L.";
  c.literature =
      "D. O. Potyondy, P. A. Cundall, Int. J. Rock Mech. Min. Sci. 41, 1329 (2004), DOI "
      "10.1016/j.ijrmms.2004.09.011; V. A. Kuzkin, I. E. Asonov, Phys. Rev. E 86, 051301 (2012), DOI "
      "10.1103/PhysRevE.86.051301";
  c.run = run;
  return c;
}

}  // namespace ropewalk
