// A rod under tension and a twisting moment: where it turns into a helix.
#include <cmath>

#include "cases/common/chain.hpp"

namespace ropewalk::validate::pulled_helix {
namespace {

constexpr int bonds = 60;

// The lowest eigenvalue of a straight chain, stretched by the tension and twisted by the moment, whose ends stay on
// the axis and tilt freely.
double lowest(const ParameterSet& set, double tension, double moment) {
  Chain c(set, bonds);
  const double twist = std::asin(moment * set.element_length / set.bond.twist);
  const double stretched = set.element_length * (1 + tension / set.bond.stretch);
  std::vector<int> freedoms;
  for (int i = 0; i <= bonds; ++i) {
    c.state.position.set(static_cast<std::size_t>(i), {0, 0, i * stretched});
    c.state.orientation.set(static_cast<std::size_t>(i), turn_about(Vector3::UnitZ(), i * twist));
    const bool inner = i > 0 && i < bonds;
    for (const int k : {0, 1})
      if (inner) freedoms.push_back(6 * i + k);
    for (const int k : {3, 4}) freedoms.push_back(6 * i + k);
  }
  return lowest_eigenvalue(tangent_stiffness(set.bond, set.element_length, c.state, freedoms));
}

CaseResult run(const CaseContext& context) {
  const ParameterSet model = context.model(), oracle = context.set();
  const double length = bonds * model.element_length;
  const double euler = std::pow(units::pi / length, 2) * oracle.bond.bend;  // eV/nm
  const auto theory = [&](double tension) { return 2 * std::sqrt(oracle.bond.bend * (tension + euler)); };
  refuse_slip(oracle, theory(6 * euler));
  CaseResult result;
  std::vector<double> tensions, moments;
  for (const double times : {0.0, 1.0, 3.0, 6.0}) {
    const double tension = times * euler, expected = theory(tension);
    const double most = std::min(1.5 * expected, 0.99 * model.bond.twist / model.element_length);
    const double moment = zero_between([&](double m) { return lowest(model, tension, m); }, 0.5 * expected, most);
    tensions.push_back(tension * units::eV_in_nN_nm);
    moments.push_back(moment * units::eV_in_nN_nm);
    if (times == 0 || times == 6)
      result.check_relative(
          times == 0 ? "critical moment without tension" : "critical moment at six times the Euler load, pulling",
          moment * units::eV_in_nN_nm, expected * units::eV_in_nN_nm, 3e-2, "nN nm",
          "a bond twists by up to 0.3 rad, whose cosine is 4 % below one");
  }
  result.figure("Critical moment against tension", {"tension", "nN"}, {"moment", "nN nm"},
                "Moment at which the pulled and twisted chain loses its lateral stiffness.",
                {theory_curve("2 sqrt(EI (T + pi²EI/L²))", tensions.front(), tensions.back(),
                              [&](double t) { return theory(t * units::nN_nm) * units::eV_in_nN_nm; }),
                 model_points("chain", tensions, moments)});
  return result;
}

const RegisteredCase registered([] {
  Case c;
  c.name = "pulled-helix";
  c.order = 35;
  c.law = Case::Law::none;
  c.run = run;
  c.turns_red = {wrong_EI(1.1)};
  return c;
});

}  // namespace
}  // namespace ropewalk::validate::pulled_helix
