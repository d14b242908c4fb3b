// Where a small rope stays stable: the area over time step and contact viscosity.
#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "cases/common/bundle.hpp"
#include "cases/common/scene_of_case.hpp"
#include "cases/common/stability_limit.hpp"
#include "scene/prepare.hpp"

namespace ropewalk::validate::contact_viscosity {
namespace {

constexpr int tubes = 7, elements = 4;
constexpr double viscosities[] = {5000, 1500, 500, 200, 100, 50, 20, 8, 2, 0.2};  // eV ps/nm^2
constexpr double on_table[] = {5000, 200, 20};

// As `run` has it, with the damping of a scene.
Prepared rope_of(const ParameterSet& set) {
  Scene scene = scene_of_case("limit-contact-viscosity", set,
                              {{"rope.length_nm", fmt::to_string(elements * set.element_length)}});
  return prepare(scene);
}

// Steps in fs at each viscosity.
struct Limits {
  std::vector<double> viscosity, found, theory, estimate, chosen;
  double of_scene = 0, step_of_scene = 0;  // viscosity and step where nothing is typed
};

Limits limits_of(const CaseContext& context) {
  Prepared oracle = rope_of(context.set()), model = rope_of(context.model());
  Bundle rest{oracle.topology, oracle.interaction, oracle.state, oracle.spacing, oracle.time_step};
  bring_to_rest(rest);
  oracle.state = model.state = rest.state;
  Limits out;
  out.of_scene = oracle.interaction.damping.contact.eta;
  out.step_of_scene = oracle.time_step / units::fs;
  for (const double eta : viscosities) {
    for (Prepared* p : {&oracle, &model}) p->interaction.damping.contact.eta = eta;
    const double theory = largest_damped_step(oracle.topology, oracle.interaction, oracle.state);
    const double estimate = time_step_limit(oracle.topology, oracle.interaction, oracle.spacing).limit;
    out.viscosity.push_back(eta);
    out.found.push_back(largest_step(model.topology, model.interaction, model.state, theory) / units::fs);
    out.theory.push_back(theory / units::fs);
    out.estimate.push_back(estimate / units::fs);
    out.chosen.push_back(cold_step_fraction * estimate / units::fs);
  }
  return out;
}

// Between no step and the limit.
ChartLine stable_area(const Limits& l) {
  ChartLine area;
  area.name = "stable";
  area.filled = true;
  area.x = l.found;
  area.y = l.viscosity;
  area.x.insert(area.x.end(), {0, 0});
  area.y.insert(area.y.end(), {l.viscosity.back(), l.viscosity.front()});
  return area;
}

CaseFigure map_of(const Limits& l) {
  CaseFigure figure = case_figure(
      "Where seven tubes stay stable, by time step and contact viscosity", {"time step", "fs"},
      {"contact viscosity", "eV ps/nm^2", false, true},
      fmt::format(
          "Seven tubes at rest. Shaded: stable, up to the largest step by bisection. The estimate of `run`, "
          "which refuses steps beyond it, is lower: it is that of an endless rope under load. A scene has by "
          "default {} eV ps/nm^2 and a step of {} fs. A viscosity of {} allows 1/{} of the step of {}.",
          number_text(l.of_scene, 3), number_text(l.step_of_scene, 3), number_text(l.viscosity.front(), 4),
          number_text(l.found.back() / l.found.front(), 2), number_text(l.viscosity.back(), 2)),
      {model_points("by bisection", l.found, l.viscosity),
       {"dt^2 K + 2 dt D = 4", l.theory, l.viscosity, 0},
       {"estimate of a run", l.estimate, l.viscosity, 2},
       {"0.9 of it, the default step", l.chosen, l.viscosity, 5, true},
       stable_area(l),
       model_points("default of a scene", {l.step_of_scene}, {l.of_scene}, 3)});
  figure.on_map = true;
  return figure;
}

CaseResult run(const CaseContext& context) {
  const Limits l = limits_of(context);
  CaseResult result;
  double least = 1e9, most = 0;
  int above = 0;
  for (std::size_t k = 0; k < l.viscosity.size(); ++k) {
    const std::string name = fmt::format("viscosity {:g} eV ps/nm^2", l.viscosity[k]);
    result.check_relative(name, l.found[k], l.theory[k], 0.05, "fs", "small motions about rest");
    if (std::count(std::begin(on_table), std::end(on_table), l.viscosity[k]) > 0)
      result.limits.push_back({"time step, seven tubes, " + name, l.found[k], l.theory[k], "fs",
                               Limit::Guard::refused,
                               "a time step above the estimate, which includes the viscosity"});
    const double margin = l.found[k] / l.estimate[k];
    above += margin < 1 ? 1 : 0;
    least = std::min(least, margin);
    most = std::max(most, margin);
  }
  // The estimate of `run` must never lie above the stable step.
  result.check_absolute("estimates of `run` above the limit", above, 0, 0, "",
                        fmt::format("of {} viscosities", l.viscosity.size()));
  result.show_absolute("smallest limit over estimate", least, 1, 0, "",
                       "`run` takes 0.9 of the estimate in cold scenes");
  result.figures.push_back(map_of(l));
  result.remarks.push_back(
      fmt::format("Viscosity at the contact is explicit, as all damping, and lowers the step. The estimate leaves "
                  "a margin of {:.2g} to {:.2g} here: it is that of a tube with six neighbours under load, and "
                  "the outer tubes of this rope have three.",
                  least, most));
  return result;
}

const RegisteredCase registered([] {
  Case c;
  c.name = "limit-contact-viscosity";
  c.order = 30;
  c.run = run;
  c.turns_red = {wrong_stiffnesses(1.2)};
  return c;
});

}  // namespace
}  // namespace ropewalk::validate::contact_viscosity
