// The critical load of a compressed column.
#include <cmath>

#include "cases/common/chain.hpp"

namespace ropewalk::validate::euler_buckling {
namespace {

CaseResult run(const CaseContext& context) {
  const ParameterSet model = context.model(), oracle = context.set();
  const auto euler = [&](double length) { return std::pow(units::pi / length, 2) * oracle.bond.bend; };
  CaseResult result;
  std::vector<double> lengths, loads;
  for (const int bonds : {16, 20, 24, 30, 40, 60}) {
    const double length = bonds * model.element_length, expected = euler(length);
    const double load = buckling_load(model, bonds, expected);
    lengths.push_back(length);
    loads.push_back(load);
    if (bonds == 20 || bonds == 60)
      result.check_relative("critical load of " + std::to_string(bonds) + " bonds", load, expected,
                            bonds == 20 ? 1e-2 : 3e-3, "eV/nm",
                            "the column shortens by `P/EA` before it buckles; the elements' error falls with the "
                            "square of their length");
  }
  result.figure("Euler load against the length of the column", {"length", "nm"}, {"critical load", "eV/nm"},
                "Load at which the lowest eigenvalue of the chain's stiffness passes zero.",
                {theory_curve("pi^2 EI/L^2", lengths.front(), lengths.back(), euler),
                 model_points("loss of stiffness of the chain", lengths, loads)});
  return result;
}

const RegisteredCase registered([] {
  Case c;
  c.name = "euler-buckling";
  c.order = 20;
  c.law = Case::Law::none;
  c.run = run;
  c.turns_red = {wrong_EI(1.1)};
  return c;
});

}  // namespace
}  // namespace ropewalk::validate::euler_buckling
