// A rope with incremental parallel bonds whose grip moves around closed loops.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "cases/common/driven_rope.hpp"

namespace ropewalk::validate::rope_parallel_bond {
namespace {

constexpr int bonds = 12, rounds = 2;
constexpr double angle = 48 * units::degree, shift = 2;  // nm
constexpr double brake = 1.5;                            // 1/ps: nearly aperiodic for the slowest bending mode
constexpr double leg = 8, settle = 30;                   // ps
constexpr double step_fraction = 0.5;  // of the limit of total-energy bonds; that of incremental ones is lower
constexpr double temperature = 300, warm = 20;  // K, ps

using Bonds = DrivenRope::Bonds;

// Starts and ends at rest.
double eased(double part) { return part * part * (3 - 2 * part); }
// How far the k-th of n legs is done at this part of the whole path, 0 .. 1.
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

// The rope at rest, with its grips in their first place.
DrivenRope settled(const ParameterSet& set, Bonds kind, double fraction = step_fraction) {
  DrivenRope rope(set, bonds, kind, fraction, brake);
  rope.rest(settle);
  return rope;
}

struct Left {
  double energy = 0, moment = 0;  // eV
};

Left left_in(const DrivenRope& rope, const DrivenRope& start) {
  return {rope.energy() - start.energy(), rope.moment() - start.moment()};
}

Left move_around(const DrivenRope& start, const Loop& loop, double leg_duration) {
  DrivenRope rope = start;
  rope.move(loop.at, loop.legs * leg_duration);
  rope.rest(settle);
  return left_in(rope, start);
}

// Twist and energy left after 0, 1, .. rounds of heating and cooling with the grips held.
std::vector<Left> shake(const DrivenRope& start) {
  DrivenRope rope = start;
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

Twisted twisted(const DrivenRope& start) {
  DrivenRope rope = start;
  rope.move([](double part) { return GripPlace{angle * eased(part), {0, 0, 0}}; }, leg);
  rope.rest(settle);
  return {rope.energy() - start.energy(), rope.twist(), rope.moment()};
}

constexpr double returns = 1e-4;         // eV: far below the heat of one degree of freedom at 300 K, 1.3e-2
constexpr double moment_returns = 1e-2;  // eV: 1e-5 of the twisting moment

void add_return_checks(const std::string& path, const Left& left, CaseResult& result) {
  result.check_absolute("total energy: energy left, " + path, left.energy, 0, returns, "eV",
                        "a function of the state; the tolerance is for motion that is left");
  result.check_absolute("total energy: moment left, " + path, left.moment, 0, moment_returns, "eV");
}

void add_residue(const std::string& path, const Left& left, CaseResult& result, const std::string& note = "") {
  result.show_absolute("incremental: energy left, " + path, left.energy, 0, returns, "eV", note);
  result.show_absolute("incremental: moment left, " + path, left.moment, 0, moment_returns, "eV");
}

// The rope at rest with total-energy bonds, with incremental ones, and with these at half the time step.
struct Ropes {
  DrivenRope total, coarse, fine;
};

void add_twist_checks(const Ropes& ropes, const ParameterSet& oracle, CaseResult& result) {
  const Twisted ours = twisted(ropes.total), theirs = twisted(ropes.coarse);
  const double spacing = line_parallel_well(oracle.line->density).distance;
  result.check_relative(
      "total energy: torsion of the twisted rope", ours.twist,
      torsion_energy(oracle.bond, spacing, bonds * oracle.element_length, angle), 1e-2, "eV",
      "the clamped ends straighten the helix; this changes the energy by less than `1 - cos^2 beta`");
  result.show_relative("incremental: energy of the twisted rope", theirs.energy, ours.energy, 1e-2, "eV",
                       "twisted once: the same rope");
  result.show_relative("incremental: moment of the twisted rope", theirs.moment, ours.moment, 1e-2, "eV");
}

// Extrapolates energies to infinite duration; each belongs to twice the duration of the one before.
double at_no_speed(const std::vector<double>& energy) {
  const std::size_t n = energy.size();
  return (4 * energy[n - 1] - energy[n - 2]) / 3;
}

void add_loop_checks(const Ropes& ropes, CaseResult& result) {
  std::vector<double> duration, by_back, by_square, energy_back, energy_square;
  for (const double slower : {1.0, 2.0, 4.0}) {
    duration.push_back(slower * leg);
    const auto legs = fmt::format(", legs of {:.0f} ps", duration.back());
    const Left b = move_around(ropes.coarse, back, duration.back());
    const Left s = move_around(ropes.coarse, square, duration.back());
    add_residue(back.name + legs, b, result,
                "falls with the square of the speed: inertia takes the rope off the path");
    add_residue(square.name + legs, s, result);
    energy_back.push_back(b.energy);
    energy_square.push_back(s.energy);
    by_back.push_back(1e3 * b.energy);
    by_square.push_back(1e3 * s.energy);
  }
  for (const auto& [name, energy] : {std::pair(back.name, energy_back), std::pair(square.name, energy_square)})
    result.show_absolute("incremental: energy left without speed, " + name, at_no_speed(energy), 0, returns, "eV",
                         "extrapolated from the two slowest, with the square of the speed");
  add_residue(fmt::format("{}, legs of {:.0f} ps, half the time step", square.name, leg),
              move_around(ropes.fine, square, leg), result);
  add_return_checks(back.name, move_around(ropes.total, back, leg), result);
  add_return_checks(square.name, move_around(ropes.total, square, leg), result);
  result.figure(
      "Energy left by incremental bonds after one closed loop of a grip", {"duration of a leg", "ps"},
      {"energy", "meV"},
      "Incremental bonds, with the grip back in place and the rope at rest. A slow path there and back the same "
      "way leaves no energy. A path around an area leaves some, however slow.",
      {theory_curve("a function of the state", 0, duration.back(), [](double) { return 0.0; }),
       model_points("twisted and back", duration, by_back, 3),
       model_points("and shifted between", duration, by_square, 2)});
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
  add_residue(path, coarse.back(), result, "errors of small rotations add up as a random walk");
  add_residue(path + ", half the time step", fine.back(), result);
  result.figure(
      "Energy left in a rope after heating and cooling", {"time at 300 K", "ps"}, {"energy", "eV"},
      "The rope is held, warmed and cooled. The elements come to rest again, but the rest angles of incremental "
      "bonds have moved.",
      {theory_curve("a function of the state", 0, rounds * warm, [](double) { return 0.0; }),
       heat_line("total energy", total, 1), heat_line("incremental", coarse, 2),
       heat_line("incremental, step/2", fine, 3)});
}

CaseResult run(const CaseContext& context) {
  const ParameterSet model = context.model();
  const Ropes ropes{settled(model, Bonds::total_energy), settled(model, Bonds::incremental),
                    settled(model, Bonds::incremental, 0.5 * step_fraction)};
  CaseResult result;
  add_twist_checks(ropes, context.set(), result);
  context.progress("moving the grip around closed loops");
  add_loop_checks(ropes, result);
  context.progress("heating and cooling");
  add_heat_checks(ropes, result);
  result.remarks.push_back(
      "Twisted once, a rope of incremental bonds equals one of total-energy bonds. After a closed loop it keeps "
      "energy for two reasons. First, inertia takes the rope off the path; this part vanishes with the speed. "
      "Second, a path that "
      "encloses an area of bend and twist leaves energy at any speed; this part is small at the bond angles that a "
      "tube allows.");
  result.remarks.push_back(
      "Heat is worse than loops. Warm elements go through thousands of small loops, and each step adds an error of "
      "second order in its rotations. The rest angles of the bonds drift, and the rope stores energy that no load "
      "has put there. Smaller steps leave less, but not nothing. Total-energy bonds accumulate nothing at any "
      "step.");
  return result;
}

const RegisteredCase registered([] {
  Case c;
  c.name = "rope-parallel-bond";
  c.group = Case::Group::codes;
  c.order = 50;
  c.tier = Case::Tier::full;
  c.title = "A rope with incremental parallel bonds";
  c.why =
      "A rope that is loaded and unloaded must come back to the same state. Bonds that depend on the path leave a "
      "moment in it that no load explains.";
  c.setup = fmt::format(
      "Seven {{tube}} tubes of {} bonds between two grips, with the line law between tubes, in damped "
      "motion with a time step of {} of the stability limit. One grip moves around closed loops: twisted by {:.0f} "
      "degrees and back; twisted, shifted sideways by {:.0f} nm, twisted back, shifted back; each leg takes {:.0f} "
      "ps or more. In another run the grips are held, {} times {:.0f} ps without damping at {:.0f} K. Each run "
      "ends at rest. All runs are made with total-energy bonds and with incremental ones.",
      bonds, step_fraction, angle * units::rad_in_degree, shift, leg, rounds, warm, temperature);
  c.oracle =
      "Energy and moment are functions of the state: both vanish when the grips are back. Torsion energy of the "
      "twisted rope `GJ phi^2 (1 + 6 cos^2 beta)/(2 L)`, `tan beta = R0 phi/L`.";
  c.literature =
      "D. O. Potyondy, P. A. Cundall, Int. J. Rock Mech. Min. Sci. 41, 1329 (2004), DOI "
      "10.1016/j.ijrmms.2004.09.011; V. A. Kuzkin, I. E. Asonov, Phys. Rev. E 86, 051301 (2012), DOI "
      "10.1103/PhysRevE.86.051301";
  c.run = run;
  c.turns_red = {wrong_GJ(0.9)};
  return c;
});

}  // namespace
}  // namespace ropewalk::validate::rope_parallel_bond
