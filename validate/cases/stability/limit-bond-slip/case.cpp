// The twisting moment at which a bond slips.
#include <cmath>
#include <limits>

#include "cases/common/stability_limit.hpp"
#include "model/error.hpp"

namespace ropewalk::validate::bond_slip {
namespace {

constexpr int increments = 24;

// Two elements: one is held, a couple turns the other in growing steps. Returns the twist at rest (rad); NaN where
// the bond slips.
double twisted(const ParameterSet& set, double moment) {
  Chain c(set, 1);
  for (int k = 1; k <= increments; ++k) {
    c.loads = {};
    c.loads.add(FixLoad({0}));
    c.loads.add(TorqueLoad({1}, Vector3(0, 0, moment * k / increments)));
    try {
      c.state = c.relaxed(1e-6).state();
    } catch (const NumericalError&) {
      return std::numeric_limits<double>::quiet_NaN();
    }
    c.state.velocity = c.state.angular_velocity = Vec3Array(c.state.size());
  }
  return bond_twist_angle(frame_of(c.state.orientation[0]), frame_of(c.state.orientation[1]));
}

CaseResult run(const CaseContext& context) {
  const ParameterSet model = context.model(), oracle = context.set();
  const double theory = oracle.bond.twist / oracle.element_length;
  const double found =
      limit_between([&](double m) { return std::isnan(twisted(model, m)); }, 0.5 * theory, 1.6 * theory, 3e-3);
  CaseResult result;
  result.check_relative("moment at which a bond slips", found / units::nN_nm, theory / units::nN_nm, 0.05, "nN nm",
                        "in 24 increments, each brought to rest");
  result.show_absolute("moment on a tube at a twist of 10 degrees per element",
                       theory * std::sin(10 * units::degree) / units::nN_nm,
                       theory * 10 * units::degree / units::nN_nm, 0, "nN nm",
                       "the torque of a bond is a sine, 0.5 % below that of a rod at 10 degrees");
  result.limits.push_back({"moment at which a bond slips", found / units::nN_nm, theory / units::nN_nm, "nN nm",
                           Limit::Guard::stopped, "a bond twisted by 90 degrees; names its element"});
  std::vector<double> angle, moment;
  for (double part = 0.1; part < 1; part += 0.1) {
    angle.push_back(twisted(model, part * theory) / units::degree);
    moment.push_back(part * theory / units::nN_nm);
  }
  result.figure("Torque of a bond", {"twist of the bond", "degrees"}, {"moment", "nN nm"},
                "Beyond 90 degrees no angle is at rest: the bond slips.",
                {theory_curve("GJ/a sin", 0, 180,
                              [&](double x) { return theory * std::sin(x * units::degree) / units::nN_nm; }),
                 model_points("at rest under a couple", angle, moment)});
  return result;
}

const RegisteredCase registered([] {
  Case c;
  c.name = "limit-bond-slip";
  c.order = 40;
  c.law = Case::Law::none;
  c.run = run;
  c.turns_red = {wrong_GJ(0.9)};
  return c;
});

}  // namespace
}  // namespace ropewalk::validate::bond_slip
