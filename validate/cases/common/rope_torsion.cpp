#include "cases/common/rope_torsion.hpp"

#include <fmt/format.h>

#include <cmath>

#include "core/checks.hpp"
#include "model/contact/line_parameters.hpp"

namespace ropewalk::validate {
namespace {

using Length = RopeInMachine::Length;

constexpr int elements = 24;
constexpr double in_nN_nm = units::eV_in_nN_nm;

// nN/nm^2.
double gigapascals(double pressure) { return pressure * units::eV_in_nN_nm; }

// Whether the tubes stay within four fifths of their limits.
bool bearable(const RopeInMachine& rope, double twist) {
  const Validity& v = rope.set.validity;
  const double shear = rope.set.radius * twist, strain = std::hypot(1, rope.outer_radius() * twist) - 1;
  return shear < 0.8 * v.collapse_at(rope.set.radius, rope.length) && strain < 0.8 * v.stretch;
}

// Sorted by question, so that a fault turns its own checks red.
void check_at(const RopeInMachine& rope, const CaseTube& tube, double degrees, Length kept, CaseResult& result) {
  const double twist = rope.twist_at(degrees * units::degree);
  const RopeInMachine::Reading seen = rope.wound(twist, kept), exact = rope.theory(tube.set, twist, kept);
  const bool paper = !tube.set.law<LineParameters>();
  const std::string at =
      fmt::format("{} tubes of {}, {:g}°", rope.tubes, paper ? "the published set" : tube.name, degrees);
  const bool initial = degrees<1, steep = degrees> 12;
  const char* why = initial ? (paper ? "the published contact varies along the tubes with the elements" : "closed form")
                    : steep ? "radii change by up to 1 %, and crowding is known to its first order in the curvature"
                            : "radii change a little, and crowding is known to its first order in the curvature";
  result.check_relative("torque per tube, " + at, seen.torque * in_nN_nm, exact.torque * in_nN_nm,
                        initial ? (paper ? 2e-2 : 1e-2)
                        : steep ? 5e-2
                                : 2e-2,
                        "nN nm", why);
  if (initial) return;
  if (kept == Length::held) {
    result.check_relative("tension per tube, " + at, seen.tension * in_nN_nm, exact.tension * in_nN_nm, 2e-2, "nN");
  } else {
    result.check_relative("contraction, " + at, 100 * (1 - seen.stretch), 100 * (1 - exact.stretch), 3e-2, "%");
  }
  const double mass = (rope.topology.length_of(0) - 1) * rope.topology.types[0].mass;  // between the clamps
  if (kept == Length::held && degrees == 10)
    result.check_relative("specific energy, " + at, seen.energy / mass, exact.energy / mass, 3e-2, "MJ/kg", why);
  if (kept == Length::held && steep)
    result.check_absolute("share of stretch in the bonds, " + at, 100 * seen.stretch_share,
                          100 * exact.stretch_share, 3, "%");
  if (rope.tubes >= 37 && degrees == 10)
    result.check_relative(
        "pressure on the core, " + at, gigapascals(seen.core_pressure), gigapascals(exact.core_pressure), 0.15,
        "GPa",
        "crowding draws the middle apart with more than tension presses on it; a discrete lattice of a few rings");
}

}  // namespace

CaseResult run_rope_torsion(const CaseContext& context, Length kept) {
  CaseResult result;
  CaseFigure figure = case_figure(
      "Torque of a rope against its twist", {"lean of the outermost tubes", "°"}, {"torque per tube", "nN nm"},
      "Of the first set. Angles at which a tube would pass four fifths of its limits are left out.");
  int colour = 0;
  for (std::size_t k = 0; k < (context.brief ? 1 : context.sets.size()); ++k) {
    const CaseTube tube = context.tube(k);
    // Other sets have fewer sizes, for the time that they take.
    const std::vector<int> sizes =
        context.given || context.brief || k > 0 ? std::vector<int>{7, 37} : std::vector<int>{7, 19, 37, 91};
    for (const int tubes : sizes) {
      const RopeInMachine rope(tube.model, tubes, elements);
      std::vector<double> leans, torques;
      for (const double degrees : {0.5, 5.0, 10.0, 15.0}) {
        const double twist = rope.twist_at(degrees * units::degree);
        if (!bearable(rope, twist)) continue;
        if (context.progress)
          context.progress(fmt::format("{} tubes of {}, {:g} degrees", tubes, tube.name, degrees));
        const std::size_t before = result.checks.size();
        check_at(rope, tube, degrees, kept, result);
        leans.push_back(degrees);
        torques.push_back(result.checks[before].value);
      }
      if (k > 0 || (tubes != sizes.front() && tubes != sizes.back())) continue;
      figure.chart.lines.push_back(
          theory_curve(fmt::format("theory, {} tubes", tubes), 0.5, leans.back(), colour, [&](double lean) {
            return rope.theory(tube.set, rope.twist_at(lean * units::degree), kept).torque * in_nN_nm;
          }));
      figure.chart.lines.push_back(model_points(fmt::format("{} tubes", tubes), leans, torques, colour));
      ++colour;
    }
  }
  result.figures.push_back(figure);
  return result;
}

Case rope_torsion_case() {
  Case c;
  c.tier = Case::Tier::full;
  c.law = Case::Law::none;
  c.sets = {"cnt-10-10-tersoff", "cnt-10-10-paper"};
  return c;
}

}  // namespace ropewalk::validate
