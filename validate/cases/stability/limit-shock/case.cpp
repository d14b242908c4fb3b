// How fast a moment may rise on a rope of some length before the motion decides where it goes.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cases/common/bundle.hpp"
#include "cases/common/scene_of_case.hpp"
#include "cases/common/stability_limit.hpp"
#include "plan/forecast.hpp"
#include "scene/prepare.hpp"
#include "scene/watch.hpp"

namespace ropewalk::validate::twist_shock {
namespace {

constexpr double wall_shear = 0.02;  // shear of the wall under the whole moment: twist per length times radius
constexpr double limit = 0.25;       // the default of limits.shock
constexpr double least = 0.6, most = 1.2;  // reached, over the estimate

struct Load {
  int tubes = 7, elements = 30;
  double rate = 0;  // rate of the moment on each tube, eV/ps
};

double whole_moment(const ParameterSet& set) { return wall_shear * set.bond.twist / set.radius; }  // eV

// The moment of the oracle's set rises at the rate and is then held as long. `set`: of the tubes.
struct Rope {
  Scene scene;
  Prepared prepared;

  Rope(const Load& load, const ParameterSet& set, const ParameterSet& oracle) {
    const double moment = whole_moment(oracle);
    scene = scene_of_case("limit-shock", set,
                          {{"rope.tubes", fmt::to_string(load.tubes)},
                           {"rope.length_nm", fmt::to_string(load.elements * set.element_length)},
                           {"twist.moment_nN_nm", fmt::to_string(moment / units::nN_nm)},
                           {"twist.rate_nN_nm_per_ps", fmt::to_string(load.rate / units::nN_nm)},
                           {"twist.hold_ps", fmt::to_string(moment / load.rate)}});
    prepared = prepare(scene);
  }
};

double length_of(const Load& load, const ParameterSet& set) { return load.elements * set.element_length; }

// The program's estimate goes as the square of the rate.
double rate_for(double shock, Load load, const ParameterSet& set) {
  load.rate = whole_moment(set) / 100;
  const Rope rope(load, set, set);
  return load.rate * std::sqrt(shock / expected_shock(rope.scene, rope.prepared));
}

// The largest kinetic energy over the energy of twist under the whole moment.
double reached(const Load& load, const CaseContext& context) {
  const Rope rope(load, context.model(), context.set());
  const double twist = twist_energy_of(rope.scene, rope.prepared.topology, rope.prepared.loads);
  Simulation s = start(rope.scene, rope.prepared);
  const long steps = std::lround(rope.prepared.duration / rope.prepared.time_step);
  double kinetic = 0;
  for (long k = 0; k < steps; k += 10) {
    s.steps(10);
    kinetic = std::max(kinetic, kinetic_energy(rope.prepared.topology, s.state()));
  }
  return kinetic / twist;
}

// The rate from which `ropewalk check` warns, and the rate of the formula: kinetic energy m rho^2 L (L
// dM/dt/GJ)^2/24, four times, over M^2 L/2GJ. Six of seven tubes are a spacing from the axis.
double warned_from(const Load& load, const CaseContext& context) {
  const double about = rate_for(limit, load, context.set());
  return limit_between(
      [&](double rate) {
        Load faster = load;
        faster.rate = rate;
        const Rope rope(faster, context.model(), context.set());
        const std::vector<std::string> ahead = limits_ahead(rope.scene, rope.prepared);
        return std::any_of(ahead.begin(), ahead.end(),
                           [](const std::string& s) { return s.find("bring shock") != std::string::npos; });
      },
      about / 4, 4 * about);
}

double warned_in_theory(const Load& load, const ParameterSet& set) {
  const Bundle pair = line_bundle(set, 2, 2);
  const double mass = pair.topology.types[0].mass / set.element_length,
               mean_rho2 = 6.0 / 7 * pair.spacing * pair.spacing;
  return whole_moment(set) * set.bond.twist / length_of(load, set) *
         std::sqrt(3 * limit / (mass * mean_rho2 * set.bond.twist));
}

// --- The figure ---

ChartLine contour(double shock, const ParameterSet& set, const std::vector<int>& elements) {
  ChartLine line;
  line.name = fmt::format("kinetic/twist {:g}", shock);
  line.colour = 0;
  line.dashed = shock != limit;
  for (const int n : elements) {
    const Load load{7, n};
    line.x.push_back(length_of(load, set));
    line.y.push_back(rate_for(shock, load, set) / units::nN_nm);
  }
  return line;
}

CaseResult run(const CaseContext& context) {
  const ParameterSet& set = context.set();
  CaseResult result;
  ChartLine marks = model_points("runs", {}, {});
  std::vector<std::string> labels;
  double low = 1e9, high = 0;
  // The shocks that the program expects.
  for (const auto& [tubes, elements, expected] :
       {std::tuple{7, 30, 0.05}, std::tuple{7, 30, 0.2}, std::tuple{7, 60, 0.05}, std::tuple{7, 60, 0.2},
        std::tuple{7, 60, 0.7}, std::tuple{7, 120, 0.2}, std::tuple{7, 120, 0.7}, std::tuple{19, 60, 0.2}}) {
    Load load{tubes, elements};
    load.rate = rate_for(expected, load, set);
    const std::string name =
        fmt::format("{} tubes, {:.0f} nm, {:.2g} nN nm/ps", tubes, length_of(load, set), load.rate / units::nN_nm);
    if (context.progress) context.progress(name);
    const double shock = reached(load, context), ratio = shock / expected;
    result.check_absolute(name + ": reached over estimate", ratio, 0.5 * (least + most), 0.5 * (most - least), "",
                          fmt::format("{:.2g} by the estimate", expected));
    low = std::min(low, ratio);
    high = std::max(high, ratio);
    if (tubes != 7) continue;
    marks.x.push_back(length_of(load, set));
    marks.y.push_back(load.rate / units::nN_nm);
    labels.push_back(fmt::format("{:.2g}", shock));
  }
  const Load middle{7, 60};
  result.limits.push_back({fmt::format("ramp rate of a moment, seven tubes of {:.0f} nm", length_of(middle, set)),
                           warned_from(middle, context) / units::nN_nm,
                           warned_in_theory(middle, set) / units::nN_nm, "nN nm/ps", Limit::Guard::told,
                           "before the run by the estimate, and in it where limits.shock is passed"});
  CaseFigure figure = case_figure(
      "Kinetic over twist energy by length and ramp rate", {"length", "nm", false, true},
      {"ramp rate of the moment", "nN nm/ps", false, true},
      fmt::format(
          "Seven tubes under {:.3g} nN nm each. Lines: kinetic energy over the energy of twist, by the "
          "estimate before a run; shaded: below the limit of {:g}. Points: runs, with what they reached. Twice "
          "the length bears half the rate.",
          whole_moment(set) / units::nN_nm, limit),
      {contour(limit, set, {25, 150}), marks, contour(1, set, {25, 150}), contour(0.05, set, {25, 150})});
  figure.chart.below = "gentle";
  figure.chart.above = "violent";
  figure.labels = {{}, labels};
  figure.on_map = true;
  result.figures.push_back(figure);
  result.remarks.push_back(
      fmt::format("The runs reached {:.2f} to {:.2f} of the estimate, which goes as the square of length over time "
                  "of the ramp, whatever the moment. Far above 1 it is an upper bound, since the rope cannot "
                  "follow.",
                  low, high));
  return result;
}

const RegisteredCase registered([] {
  Case c;
  c.name = "limit-shock";
  c.order = 45;
  c.run = run;
  c.turns_red = {{wrong_GJ(2), {"7 tubes, 41 nm"}}};
  c.stays_green = {wrong_EI(2)};
  return c;
});

}  // namespace
}  // namespace ropewalk::validate::twist_shock
