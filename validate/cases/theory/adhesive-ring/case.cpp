// A long tube coiled upon itself: bending against adhesion.
#include <fmt/format.h>

#include <cmath>

#include "cases/common/bundle.hpp"

namespace ropewalk::validate::adhesive_ring {
namespace {

constexpr int elements = 364;

// A helix whose turns lie side by side in contact, without twist.
double coil_energy(const ParameterSet& set, double radius) {
  Bundle b = line_bundle(set, 1, elements);
  const double rise = b.spacing / (2 * units::pi), a = set.element_length;
  const double step = 2 * std::asin(0.5 * a / std::hypot(radius, rise));
  for (int k = 0; k < elements; ++k) {
    const double angle = k * step;
    const Vector3 tangent = Vector3(-radius * std::sin(angle), radius * std::cos(angle), rise).normalized();
    b.state.position.set(static_cast<std::size_t>(k),
                         {radius * std::cos(angle), radius * std::sin(angle), rise * angle});
    b.state.orientation.set(static_cast<std::size_t>(k), Quaternion::FromTwoVectors(Vector3::UnitZ(), tangent));
  }
  relax_spins(b.topology, b.state);
  return Simulation(b.topology, b.interaction, {}, b.state, b.time_step).forces().energy.potential();
}

double best_radius(const ParameterSet& set, double from, double to) {
  const double part = 0.5 * (std::sqrt(5.0) - 1);
  while (to - from > 1e-3) {
    const double low = to - part * (to - from), high = from + part * (to - from);
    if (coil_energy(set, low) < coil_energy(set, high))
      to = high;
    else
      from = low;
  }
  return 0.5 * (from + to);
}

CaseResult run(const CaseContext& context) {
  const ParameterSet model = context.model(), oracle = context.set();
  const double adhesion = -pair_well(oracle).energy,
               length = elements * oracle.element_length;
  const double bend = oracle.bond.bend, bent = length - oracle.element_length;  // bonds are one less
  const auto energy = [&](double r) {
    return 0.5 * bend * bent / (r * r) - adhesion * (length - 2 * units::pi * r);
  };
  const double radius = std::cbrt(bend * bent / (2 * units::pi * adhesion));
  if (length < 1.2 * 2 * units::pi * radius)
    throw NotApplicable(fmt::format("a chain of {} elements is too short to coil: one turn takes {:.3g} nm", elements,
                                    2 * units::pi * radius));
  CaseResult result;
  result.check_relative("radius of the coil", best_radius(model, 0.7 * radius, 1.2 * radius), radius, 1e-2, "nm",
                        "ends and tilt of the turns change it by less than 0.5 %");
  const double wide = 1.15 * radius, tight = 0.8 * radius;
  result.check_relative("energy from 1.15 to 0.8 of that radius",
                        coil_energy(model, tight) - coil_energy(model, wide), energy(tight) - energy(wide), 2e-2,
                        "eV", "a small difference of two large energies, bending and adhesion");
  std::vector<double> radii, energies;
  for (double r = 0.75; r < 1.2; r += 0.05) {
    radii.push_back(r * radius);
    energies.push_back(coil_energy(model, radii.back()));
  }
  result.figure("Energy of a coiled tube against its radius", {"radius", "nm"}, {"energy", "eV"},
                "A tube whose coil has less than two turns of overlap.",
                {theory_curve("EI L/2R^2 - Gamma (L - 2 pi R)", radii.front(), radii.back(), energy),
                 model_points("coiled chain", radii, energies)});
  return result;
}

const RegisteredCase registered([] {
  Case c;
  c.name = "adhesive-ring";
  c.order = 100;
  c.tier = Case::Tier::full;
  c.run = run;
  c.turns_red = {wrong_EI(1.1), wrong_contact(2)};
  return c;
});

}  // namespace
}  // namespace ropewalk::validate::adhesive_ring
