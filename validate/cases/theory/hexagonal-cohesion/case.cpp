// Cohesion of straight hexagonal ropes.
#include <cmath>

#include "cases/common/bundle.hpp"
#include "model/contact/line_parameters.hpp"

namespace ropewalk::validate::hexagonal_cohesion {
namespace {

double vdw_energy(const ParameterSet& set, int tubes, int elements) {
  const Bundle b = line_bundle(set, tubes, elements);
  return Simulation(b.topology, b.interaction, {}, b.state, b.time_step).forces().energy.vdw;
}

// Energy per length (eV/nm) as the difference of two lengths, which has no ends in it.
double energy_per_length(const ParameterSet& set, int tubes) {
  return (vdw_energy(set, tubes, 16) - vdw_energy(set, tubes, 8)) / (8 * set.element_length);
}

double contacts(double tubes) { return 3 * tubes - std::sqrt(12 * tubes - 3); }

CaseResult run(const CaseContext& context) {
  const ParameterSet model = context.model(), oracle = context.set();
  const WallsIntegral integral = surface_integral(oracle);
  const Well pair = integral.parallel_well();
  CaseResult result;
  std::vector<double> tubes, energies;
  for (const int n : {7, 19, 37, 61, 91}) {
    const double energy = energy_per_length(model, n);
    tubes.push_back(n);
    energies.push_back(energy);
    result.check_relative("energy per length of " + std::to_string(n) + " tubes", energy,
                          rope_energy(integral, n, pair.distance), 3e-3, "eV/nm",
                          "contact fitted to 1.4e-3 of the well");
  }
  result.check_relative("spacing", line_parallel_well(model.law<LineParameters>()->density).distance, pair.distance,
                        1e-3, "nm", "place of the minimum");
  const double second = std::sqrt(3.0) * pair.distance;
  result.check_absolute("energy of second neighbours",
                        line_parallel_energy(model.law<LineParameters>()->density, second),
                        integral.parallel(second), 3e-3 * std::fabs(pair.energy), "eV/nm", "as the well");
  result.figure(
      "Cohesion of hexagonal ropes", {"tubes", "", true}, {"energy per length", "eV/nm"},
      "Seven tubes have 12 contacts, 91 have 240.",
      {theory_curve("(3 N - sqrt(12 N - 3)) E(R0)", 7, 91, [&](double n) { return contacts(n) * pair.energy; }),
       model_points("ropes", tubes, energies)});
  return result;
}

const RegisteredCase registered([] {
  Case c;
  c.name = "hexagonal-cohesion";
  c.order = 90;
  c.run = run;
  c.turns_red = {wrong_contact(2)};
  return c;
});

}  // namespace
}  // namespace ropewalk::validate::hexagonal_cohesion
