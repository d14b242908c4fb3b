// Two tubes wound about each other, their own twist relaxed away: contraction and torque.
#include <cmath>

#include "cases/common/torsion_machine.hpp"
#include "core/checks.hpp"
#include "model/contact/line_parameters.hpp"

namespace ropewalk::validate::geometric_twist {
namespace {

CaseResult run(const CaseContext& context) {
  CaseResult result;
  for (std::size_t k = 0; k < context.sets.size(); ++k) {
    const CaseTube tube = context.tube(k);
    const bool paper = !tube.set.law<LineParameters>();
    const RopeInMachine pair(tube.model, 2, 40);
    const std::string of = paper ? " (published set)" : " " + tube.name;
    std::vector<double> leans, contractions;
    for (const int degrees : {5, 10}) {
      const double twist = pair.twist_at(degrees * units::degree), rho = pair.outer_radius();
      const RopeInMachine::Reading seen = pair.wound(twist, RopeInMachine::Length::free, true);
      const RopeInMachine::Reading exact = pair.theory(tube.set, twist, RopeInMachine::Length::free, true);
      const std::string at = ", " + std::to_string(degrees) + "°" + of;
      const double kept = 1 - std::sqrt(1 - std::pow(rho * twist, 2));
      result.check_relative("contraction" + at, 100 * (1 - seen.stretch), 100 * (1 - exact.stretch), 2e-2, "%");
      result.check_relative("torque per tube" + at, seen.torque * units::eV_in_nN_nm,
                            exact.torque * units::eV_in_nN_nm, degrees > 5 ? 0.1 : 5e-2, "nN nm",
                            degrees > 5 ? "what wound tubes bind more is known to its first order" : "");
      leans.push_back(degrees);
      contractions.push_back(100 * (1 - seen.stretch));
      if (degrees > 5) continue;
      result.check_relative("contraction, arc length kept" + at, 100 * (1 - seen.stretch), 100 * kept, 2e-2, "%",
                            "`L = sqrt(L0² - (r psi)²)`; bending lengthens the tubes a little");
      result.check_relative("torque per tube, leading order" + at, seen.torque * units::eV_in_nN_nm,
                            2 * tube.set.bond.bend * rho * rho * std::pow(twist, 3) * units::eV_in_nN_nm, 0.1,
                            "nN nm", "`2 EI rho² phi³`: without what wound tubes bind more than parallel ones");
    }
    if (k > 0) continue;
    result.figure("Contraction of two tubes wound about each other", {"lean", "°"}, {"contraction", "%"},
                  "Of the first set.",
                  {theory_curve("helices without torsion", 1, 10,
                                [&](double lean) {
                                  return 100 * (1 - pair.theory(tube.set, pair.twist_at(lean * units::degree),
                                                                RopeInMachine::Length::free, true)
                                                        .stretch);
                                }),
                   model_points(tube.name, leans, contractions)});
  }
  return result;
}

const RegisteredCase registered([] {
  Case c;
  c.name = "geometric-twist";
  c.order = 160;
  c.law = Case::Law::none;
  c.sets = {"cnt-10-10-tersoff", "cnt-10-10-paper"};
  c.run = run;
  c.turns_red = {{wrong_EI(1.2), {"torque per tube"}}};
  c.stays_green = {wrong_GJ(1.2)};
  return c;
});

}  // namespace
}  // namespace ropewalk::validate::geometric_twist
