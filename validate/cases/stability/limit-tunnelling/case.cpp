// The speed at which one tube passes through another.
#include <algorithm>
#include <cmath>

#include "cases/common/bundle.hpp"
#include "cases/common/stability_limit.hpp"
#include "model/error.hpp"
#include "sim/contact/line/law.hpp"

namespace ropewalk::validate::tunnelling {
namespace {

constexpr double start = 3.0;  // nm apart, out of reach

// Two single elements that cross at right angles and meet head on.
Bundle crossed(const ParameterSet& set, double speed) {
  Bundle b;
  b.interaction.law = line_law({line_contact_of(set)});
  b.place(set, 1, {{0, 0}, {0, 0}});
  b.state.position.set(0, {-0.5 * start, 0, 0});
  b.state.position.set(1, {0.5 * start, 0, 0});
  b.state.orientation.set(1, turn_about(Vector3::UnitX(), units::pi / 2));
  b.state.velocity.set(0, {0.5 * speed, 0, 0});
  b.state.velocity.set(1, {-0.5 * speed, 0, 0});
  return b;
}

// The smallest distance of the two; negative where they have passed through each other.
double closest(const ParameterSet& set, double speed, double time_step) {
  const Bundle b = crossed(set, speed);
  Simulation s(b.topology, b.interaction, {}, b.state, time_step);
  double smallest = start;
  for (double time = 0; time < 4 * start / speed && smallest > -0.5 * start; time += time_step) {
    s.step();
    smallest = std::min(smallest, s.state().position.x[1] - s.state().position.x[0]);
  }
  return smallest;
}

CaseResult run(const CaseContext& context) {
  const ParameterSet model = context.model(), oracle = context.set();
  const LineContact law = line_contact_of(oracle);
  const double barrier = law.energy(Vector3::Zero(), Vector3::UnitZ(), Vector3::UnitY());
  const double theory = std::sqrt(4 * barrier / oracle.element_mass(oracle.element_length));
  const auto fails = [&](double speed) { return closest(model, speed, 2e-3 / speed) < 0; };
  const double found = limit_between(fails, 0.3 * theory, 3 * theory);
  CaseResult result;
  result.check_relative("speed that goes through", found, theory, 0.05, "km/s",
                        "two elements, relative speed; a step of 2 pm");
  // At the default step the simulator must stop such a run.
  const Bundle b = crossed(oracle, theory);
  const double step = default_step_fraction * time_step_limit(b.topology, b.interaction, 1.7).limit;
  double stopped = 0;
  try {
    closest(model, 1.2 * theory, step);
  } catch (const NumericalError&) {
    stopped = 1;
  }
  result.check_absolute("stopped at the default step (1: yes)", stopped, 1, 0, "",
                        "a move of a quarter of the radius in a step ends the run");
  result.limits.push_back({"speed that goes through a tube", found, theory, "km/s", Limit::Guard::stopped,
                           "a move of a quarter of the radius in one step"});
  const double mass = oracle.element_mass(oracle.element_length);
  std::vector<double> distance, energy;
  for (double part = 0.1; part < 1; part += 0.1) {
    const double speed = part * theory;
    distance.push_back(closest(model, speed, 2e-3 / speed));
    energy.push_back(0.25 * mass * speed * speed);
  }
  result.figure(
      "Closest approach", {"distance of the axes", "nm"}, {"energy", "eV"},
      "The kinetic energy of two crossed elements decides how close they come. They pass through one another where "
      "it exceeds the energy of full overlap.",
      {theory_curve("energy of the law", 0, 1.8,
                    [&](double x) {
                      return law.energy({x, 0, 0}, Vector3::UnitZ(), Vector3::UnitY());
                    }),
       model_points("kinetic energy, closest approach", distance, energy)});
  return result;
}

const RegisteredCase registered([] {
  Case c;
  c.name = "limit-tunnelling";
  c.order = 30;
  c.run = run;
  c.turns_red = {wrong_contact(2)};
  return c;
});

}  // namespace
}  // namespace ropewalk::validate::tunnelling
