// Static loads on one tube: elongation, deflection and rotation of its end.
#include <algorithm>
#include <cmath>

#include "cases/common/chain.hpp"

namespace ropewalk::validate::stretch_and_cantilever {
namespace {

constexpr int bonds = 20;

struct EndMotion {
  Vector3 displacement;
  double rotation;  // about z
};

EndMotion loaded_end(const ParameterSet& set, const Vector3& force, const Vector3& torque) {
  Chain c(set, bonds);
  c.loads.add(FixLoad({0}));
  c.loads.add(ForceLoad({c.last}, force));
  c.loads.add(TorqueLoad({c.last}, torque));
  const auto end = static_cast<std::size_t>(c.last);
  const Simulation s = c.relaxed(1e-7);
  double rotation = 0;
  for (std::size_t i = 0; i < end; ++i)
    rotation += bond_twist_angle(frame_of(s.state().orientation[i]), frame_of(s.state().orientation[i + 1]));
  return {s.state().position[end] - c.state.position[end], rotation};
}

CaseResult run(const CaseContext& context) {
  const ParameterSet model = context.model(), oracle = context.set();
  const double length = bonds * model.element_length, pull = 5;
  const double sheared = oracle.bond.shear > 0 ? length / oracle.bond.shear : 0;  // bonds without kGA do not shear
  const double compliance = std::pow(length, 3) / (3 * oracle.bond.bend) + sheared;
  // Loads of a small deflection and a small twist also where a filament is far softer than a tube of carbon.
  const double largest_tip = 1e-2, tip = std::min(largest_tip, 0.01 * length / compliance);
  const double couple = std::min(5.0, 0.02 * oracle.bond.twist / model.element_length);
  CaseResult result;
  const EndMotion stretched = loaded_end(model, {0, 0, pull}, Vector3::Zero());
  result.check_relative("axial stiffness F L/u", pull * length / stretched.displacement.z(), oracle.bond.stretch,
                        1e-4, "eV/nm", "linear spring: exact");
  const EndMotion bent = loaded_end(model, {tip, 0, 0}, Vector3::Zero());
  result.check_relative("deflection under a force across", bent.displacement.x(), tip * compliance, 2e-4, "nm",
                        "the bond is the exact element of this beam");
  ParameterSet slender = model;
  slender.bond.shear = 0;
  result.check_relative("deflection without shear",
                        loaded_end(slender, {tip, 0, 0}, Vector3::Zero()).displacement.x(),
                        tip * std::pow(length, 3) / (3 * oracle.bond.bend), 2e-4, "nm");
  const EndMotion turned = loaded_end(model, Vector3::Zero(), {0, 0, couple});
  result.check_relative("torsional stiffness M L/phi", couple * length / turned.rotation, oracle.bond.twist, 1e-4,
                        "eV nm", "each bond twists by 0.003 rad");

  std::vector<double> force, deflection;
  for (const double part : {0.0, 0.1, 0.2, 0.3, 0.4, 0.5}) {
    const double f = part * (tip / largest_tip);
    force.push_back(f);
    deflection.push_back(f > 0 ? loaded_end(model, {f, 0, 0}, Vector3::Zero()).displacement.x() : 0.0);
  }
  result.figure(
      "Cantilever: deflection of the end against the force on it", {"force", "eV/nm"}, {"deflection", "nm"},
      "The chain bends as the beam does. At the largest force the points fall below the line of small deflections, "
      "as they do for an elastica.",
      {theory_curve("F L^3/3 EI + F L/kGA", 0, force.back(), [&](double f) { return f * compliance; }),
       model_points("chain of elements", force, deflection)});
  return result;
}

const RegisteredCase registered([] {
  Case c;
  c.name = "stretch-and-cantilever";
  c.order = 10;
  c.law = Case::Law::none;
  c.run = run;
  c.turns_red = {wrong_EA(1.1), wrong_EI(1.1), wrong_GJ(0.9)};
  return c;
});

}  // namespace
}  // namespace ropewalk::validate::stretch_and_cantilever
