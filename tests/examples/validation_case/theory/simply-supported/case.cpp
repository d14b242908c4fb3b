// A tube on two supports under a force in its middle, against the Timoshenko beam. This is the worked example of
// docs/how-to/validation-case.md: its folder in validate/cases/theory/ would be one more case of the program.
#include <algorithm>
#include <cmath>

#include "cases/common/chain.hpp"

namespace ropewalk::validate::simply_supported {
namespace {

constexpr int bonds = 20;
constexpr double force = 1e-2;  // eV/nm

// Deflections (nm) of all elements at rest.
std::vector<double> deflections(const ParameterSet& model) {
  Chain c(model, bonds);
  c.loads.add(FixLoad({0}, true, true, true, false));
  c.loads.add(FixLoad({c.last}, true, true, false, false));
  c.loads.add(ForceLoad({bonds / 2}, Vector3(force, 0, 0)));
  const Simulation rest = c.relaxed(1e-7);
  std::vector<double> out;
  for (std::size_t i = 0; i < rest.state().size(); ++i) out.push_back(rest.state().position.x[i]);
  return out;
}

CaseResult run(const CaseContext& context) {
  const ParameterSet model = context.model(), oracle = context.set();
  const double length = bonds * oracle.element_length;
  const auto beam = [&](double z) {
    const double x = std::min(z, length - z);  // from the nearer support
    return force * x * (3 * length * length - 4 * x * x) / (48 * oracle.bond.bend) +
           force * x / (2 * oracle.bond.shear);
  };
  const std::vector<double> found = deflections(model);

  CaseResult result;
  result.check_relative("deflection in the middle", found[bonds / 2], beam(0.5 * length), 1e-3, "nm",
                        "the bond is the exact element of this beam");
  result.check_relative("deflection at a quarter", found[bonds / 4], beam(0.25 * length), 1e-3, "nm");
  std::vector<double> place;
  for (std::size_t i = 0; i < found.size(); ++i) place.push_back(static_cast<double>(i) * oracle.element_length);
  result.figure(
      "Deflection of a tube on two supports", {"place along the tube", "nm"}, {"deflection", "nm"},
      "The force acts in the middle; the ends are held across the tube and turn freely.",
      {theory_curve("Timoshenko beam", 0, length, beam), model_points("chain of elements", place, found)});
  return result;
}

const RegisteredCase registered([] {
  Case c;
  c.name = "simply-supported";
  c.order = 15;  // after stretch-and-cantilever
  c.law = Case::Law::none;
  c.run = run;
  c.turns_red = {{wrong_EI(1.1), {"deflection in the middle", "deflection at a quarter"}}};
  c.stays_green = {wrong_EA(1.1), wrong_GJ(0.9), wrong_contact(2)};
  return c;
});

}  // namespace
}  // namespace ropewalk::validate::simply_supported
