// Two adhering tubes that are pulled apart at one end.
#include <cmath>

#include "cases/common/peeled_pair.hpp"

namespace ropewalk::validate::peeling_force {
namespace {

CaseResult run(const CaseContext& context) {
  const ParameterSet model = context.model(), oracle = context.set();
  const double adhesion = -pair_well(oracle).energy;
  // Cantilevers in balance with the adhesion, G = 9 EI w^2/c^4.
  const auto crack = [&](double w) { return std::pow(9 * oracle.bond.bend * w * w / adhesion, 0.25); };
  const auto force = [&](double w) { return 3 * oracle.bond.bend * w / std::pow(crack(w), 3); };
  CaseResult result;
  std::vector<double> openings, releases, forces;
  for (const double w : {1.0, 2.0, 3.0, 4.0}) {
    const Peel p = peel(model, w, crack(w));
    openings.push_back(w);
    releases.push_back(p.release);
    forces.push_back(p.force);
    const std::string at = " opened by " + std::to_string(static_cast<int>(w)) + " nm each";
    result.check_relative("2 F sin(slope)," + at, p.release, adhesion, 1e-2, "eV/nm",
                          "exact for any shape; contact fitted to 1.4e-3");
    if (w == 4.0)
      result.show_relative("force," + at, p.force, force(w), 0.1, "eV/nm",
                           "a beam clamped at the crack tip; the contact yields a little");
  }
  result.figure("Energy released by peeling, per length", {"opening of each end", "nm"},
                {"energy per length", "eV/nm"},
                "The work of the end forces per length of contact lost, from force and slope at the ends.",
                {theory_curve("adhesion of parallel tubes", 0.5, 4.5, [&](double) { return adhesion; }),
                 model_points("2 F sin(slope) of the chains", openings, releases)});
  result.figure(
      "Peeling force against opening", {"opening of each end", "nm"}, {"force", "eV/nm"},
      "The softness of the contact beyond the crack tip lowers the force of short cracks.",
      {theory_curve("beams clamped at the crack tip", 0.5, 4.5, force), model_points("chains", openings, forces)});
  return result;
}

const RegisteredCase registered([] {
  Case c;
  c.name = "peeling-force";
  c.order = 80;
  c.run = run;
  c.turns_red = {wrong_contact(2)};
  return c;
});

}  // namespace
}  // namespace ropewalk::validate::peeling_force
