// The incremental parallel bond against the total-energy bond.
#include <cmath>

#include "cases/common/chain.hpp"
#include "cases/common/parallel_bond.hpp"

namespace ropewalk::validate::parallel_bond {
namespace {

constexpr int bonds = 20;

double total_energy_deflection(const ParameterSet& set, double force) {
  Chain c(set, bonds);
  c.loads.add(FixLoad({0}));
  c.loads.add(ForceLoad({c.last}, {force, 0, 0}));
  return c.relaxed(1e-7).state().position[static_cast<std::size_t>(c.last)].x();
}

struct Loop {
  double incremental = 0, total = 0;  // energy left at the end, eV
};

// Bends and twists the second element of a bond once around a circle of this radius (rad) in the plane of the two
// angles, back to its start. The steps are so small that the energy left is not their error.
Loop closed_loop(const ParameterSet& set, double amplitude) {
  constexpr int steps = 4000;
  const double a = set.element_length;
  const Vector3 separation(0, 0, a);
  ParallelBond bond(set.bond, a);
  Quaternion at = Quaternion::Identity();
  for (int k = 1; k <= steps; ++k) {
    const double phase = 2 * units::pi * k / steps;
    const Quaternion next = small_turn({amplitude * (1 - std::cos(phase)), 0, amplitude * std::sin(phase)});
    const Eigen::AngleAxisd turn(next * at.conjugate());
    bond.advance(separation, separation, {}, {Vector3::Zero(), turn.angle() * turn.axis()});
    at = next;
  }
  const Frame still = frame_of(Quaternion::Identity());
  return {bond.energy(separation), bond_energy(set.bond, a, separation, still, frame_of(at)).total()};
}

CaseResult run(const CaseContext& context) {
  const ParameterSet oracle = context.set();
  ParameterSet model = context.model();
  model.bond.shear = 0;  // as in the incremental bond
  const double length = bonds * model.element_length;
  const auto beam = [&](double force) { return force * std::pow(length, 3) / (3 * oracle.bond.bend); };
  // Two small rotations in turn differ from their sum by half of their product. The accumulated moment follows half
  // of the spin, so that a loop of area S leaves a bend of S/2. Turning an element in its place bends and shears
  // the bond, with a stiffness of 4 EI/a together.
  const auto left = [&](double amplitude) {
    const double bend = 0.5 * units::pi * amplitude * amplitude;
    return 2 * oracle.bond.bend / oracle.element_length * bend * bend;
  };
  CaseResult result;
  const double small = 0.02;
  result.check_relative("total energy: deflection at small force", total_energy_deflection(model, small),
                        beam(small), 2e-3, "nm");
  result.check_relative("incremental: deflection at small force", parallel_bond_deflection(model, bonds, small),
                        beam(small), 2e-3, "nm", "the same beam while rotations are small");
  result.check_absolute("total energy: energy left after a closed loop of 0.3 rad", closed_loop(model, 0.3).total,
                        0, 1e-9, "eV", "a function of the state");
  result.check_relative("incremental: energy left after a closed loop of 0.1 rad",
                        closed_loop(model, 0.1).incremental, left(0.1), 3e-2, "eV",
                        "order of the commutator of two rotations");
  result.show_absolute("incremental: energy left after a closed loop of 0.3 rad",
                       closed_loop(model, 0.3).incremental, 0, 1e-9, "eV", "does not fall with the step");
  std::vector<double> force, total, incremental, amplitude, energy, none;
  for (const double f : {0.5, 1.0, 2.0, 3.0, 4.0}) {
    force.push_back(f);
    total.push_back(total_energy_deflection(model, f));
    incremental.push_back(parallel_bond_deflection(model, bonds, f));
  }
  for (int k = 1; k <= 6; ++k) {
    const Loop loop = closed_loop(model, 0.05 * k);
    amplitude.push_back(0.05 * k);
    energy.push_back(loop.incremental);
    none.push_back(loop.total);
  }
  result.show_relative("incremental against total energy at 4 eV/nm", incremental.back(), total.back(), 1e-2, "nm",
                       "one monotonic bend in a plane: no loop");
  CaseFigure bend =
      case_figure("Deflection of a cantilever", {"force", "eV/nm"}, {"deflection", "nm"},
                  "Bent once in a plane, both bonds follow the same beam, also at large deflections.");
  CaseFigure drift = case_figure("Energy left in a bond after a closed loop", {"radius of the loop", "rad"},
                                 {"energy", "eV"}, "Bent and twisted once around a loop and back to rest.");
  bend.chart.lines.push_back(theory_curve("small deflections", 0, 4, beam));
  bend.chart.lines.push_back(model_points("total-energy bond", force, total));
  bend.chart.lines.push_back(model_points("incremental bond", force, incremental, 2));
  drift.chart.lines.push_back(theory_curve("commutator of the rotations", 0, 0.3, left));
  drift.chart.lines.push_back(model_points("incremental bond", amplitude, energy, 2));
  drift.chart.lines.push_back(model_points("total-energy bond", amplitude, none));
  result.figures = {bend, drift};
  return result;
}

const RegisteredCase registered([] {
  Case c;
  c.name = "parallel-bond";
  c.order = 30;
  c.law = Case::Law::none;
  c.run = run;
  c.turns_red = {wrong_EI(1.1)};
  return c;
});

}  // namespace
}  // namespace ropewalk::validate::parallel_bond
