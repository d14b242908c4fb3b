// The largest stable time step of a rope whose tubes touch.
#include <cmath>

#include "cases/common/bundle.hpp"
#include "cases/common/stability_limit.hpp"

namespace ropewalk::validate::contact_step {
namespace {

// Seven short tubes at rest.
Bundle bundle_at_rest(const ParameterSet& set) {
  Bundle b = line_bundle(set, 7, 8);
  bring_to_rest(b);
  return b;
}

CaseResult run(const CaseContext& context) {
  const Bundle model = bundle_at_rest(context.model()), oracle = bundle_at_rest(context.set());
  const double theory = 2 / stiffest_frequency(oracle.topology, oracle.interaction, oracle.state);
  const double found = largest_step(model.topology, model.interaction, model.state, theory);
  const double estimate = time_step_limit(oracle.topology, oracle.interaction, oracle.spacing).limit;
  CaseResult result;
  result.check_relative("largest step", found / units::fs, theory / units::fs, 0.05, "fs",
                        "small motions about rest");
  result.check_relative("what `auto` takes for it", estimate / units::fs, theory / units::fs, 0.05, "fs",
                        "plane waves of an endless rope, its contact pressed to 98.5 % of the spacing");
  result.limits.push_back({"time step, seven tubes at rest", found / units::fs, theory / units::fs, "fs",
                           Limit::Guard::refused, "a time step above the estimate for tubes pressed together"});
  std::vector<double> step, grown;
  for (double part = 0.9; part < 1.1; part += 0.01) {
    step.push_back(part * theory / units::fs);
    grown.push_back(growth(model.topology, model.interaction, model.state, part * theory, 200));
  }
  result.figure(
      "Growth of a disturbance by time step", {"time step", "fs"}, {"growth of the energy", "", false, true},
      "Below the limit a disturbance keeps its size; above it the disturbance grows with every step.",
      {model_points("after 200 steps or at 10^6", step, grown),
       {"2/w of the stiffest mode", {theory / units::fs, theory / units::fs * 1.00001}, {1, 1e7}, 0, true}});
  return result;
}

const RegisteredCase registered([] {
  Case c;
  c.name = "limit-contact-step";
  c.order = 20;
  c.run = run;
  c.turns_red = {wrong_stiffnesses(1.2)};
  return c;
});

}  // namespace
}  // namespace ropewalk::validate::contact_step
