// The largest stable time step of a single tube, with elements of several lengths and with damped bonds.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cases/common/stability_limit.hpp"

namespace ropewalk::validate::chain_step {
namespace {

constexpr int bonds = 40;

// Velocity Verlet with explicit damping becomes unstable where dt^2 K + 2 dt D has the eigenvalue 4, with K and D
// the stiffness and the damping of the chain over its masses. Takes every wave number of bending, and stretch and
// twist.
double theory(const ParameterSet& set, double rate) {
  const double a = set.element_length, mass = set.element_mass(a), inertia = set.element_inertia(a);
  const BondDamping damping{rate};
  const auto beyond = [&](double dt) {
    double most =
        std::max(4 * dt * dt * set.bond.stretch / (a * mass), 4 * dt * dt * set.bond.twist / (a * inertia)) +
        4 * dt * rate;
    for (int step = 0; step <= 256; ++step) {
      const double q = units::pi * step / 256;
      const ChainMode k = chain_mode(set.bond, q, a, mass, inertia);
      const BondDamping::Mode d = damping.mode(q, a, mass, inertia);
      const double uu = dt * dt * k.uu + 2 * dt * d.uu, pp = dt * dt * k.pp + 2 * dt * d.pp,
                   up = dt * dt * k.up + 2 * dt * d.up;
      most = std::max(most, 0.5 * (uu + pp) + std::sqrt(0.25 * (uu - pp) * (uu - pp) + up * up));
    }
    return most > 4;
  };
  return limit_between(beyond, 1e-6, 10, 1e-6) / units::fs;
}

double found(const ParameterSet& set, double rate) {
  Chain c(set, bonds);
  c.interaction.damping.bond.rate = rate;
  const double about = time_step_limit(c.topology, c.interaction, 0).limit;
  return largest_step(c.topology, c.interaction, c.state, about) / units::fs;
}

CaseResult run(const CaseContext& context) {
  const ParameterSet model = context.model(), oracle = context.set();
  CaseResult result;
  std::vector<double> length, limit;
  for (const double factor : {1.0, 2.0, 4.0, 8.0}) {
    const ParameterSet m = with_elements(model, factor), o = with_elements(oracle, factor);
    length.push_back(o.element_length);
    limit.push_back(found(m, 0));
    result.check_relative(fmt::format("largest step, elements of {:.2f} nm", o.element_length), limit.back(),
                          theory(o, 0), 0.05, "fs", "a chain of 41 elements, not an endless one");
    result.limits.push_back(
        {fmt::format("time step, single tube, elements of {:.2f} nm", o.element_length), limit.back(), theory(o, 0),
         "fs", Limit::Guard::refused,
         "a time step above the estimate; `auto` takes 0.9 of it in cold scenes, 0.6 in others"});
  }
  std::vector<double> rates = {5, 20, 60}, damped;
  for (const double rate : rates) {
    damped.push_back(found(model, rate));
    result.check_relative(fmt::format("largest step, bonds damped by {:.0f}/ps", rate), damped.back(),
                          theory(oracle, rate), 0.05, "fs", "a chain of 41 elements, not an endless one");
    result.limits.push_back({fmt::format("time step, bonds damped by {:.0f}/ps", rate), damped.back(),
                             theory(oracle, rate), "fs", Limit::Guard::refused,
                             "a time step above the estimate, which includes the damping"});
  }
  result.figures = {
      step_figure(
          "element length", {"element length", "nm"},
          "One tube. The step grows with the element length: elements twice as long cost a quarter.",
          {theory_curve("2/w of the stiffest mode", length.front(), length.back(),
                        [&](double a) { return theory(with_elements(oracle, a / oracle.element_length), 0); }),
           model_points("by bisection", length, limit)}),
      step_figure("bond damping", {"damping of the bonds", "1/ps"},
                  "One tube. Explicit damping lowers the largest step.",
                  {theory_curve("dt^2 K + 2 dt D = 4", 0, 80, [&](double rate) { return theory(oracle, rate); }),
                   model_points("by bisection", rates, damped)})};
  return result;
}

const RegisteredCase registered([] {
  Case c;
  c.name = "limit-chain-step";
  c.order = 10;
  c.law = Case::Law::none;
  c.run = run;
  c.turns_red = {wrong_stiffnesses(1.2)};
  return c;
});

}  // namespace
}  // namespace ropewalk::validate::chain_step
