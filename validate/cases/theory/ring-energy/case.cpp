// A tube bent into a circle.
#include <fmt/format.h>

#include <cmath>

#include "cases/common/chain.hpp"

namespace ropewalk::validate::ring_energy {
namespace {

// Elements on a circle whose chords are as long as unstretched bonds.
double ring_energy(const ParameterSet& set, int elements, double circumference) {
  const double a = circumference / elements, step = 2 * units::pi / elements;
  const double radius = 0.5 * a / std::sin(0.5 * step);
  const auto frame = [&](int k) { return frame_of(turn_about(Vector3::UnitX(), -k * step)); };
  const auto at = [&](int k) { return Vector3(0, radius * (1 - std::cos(k * step)), radius * std::sin(k * step)); };
  return elements * bond_energy(set.bond, a, at(1) - at(0), frame(0), frame(1)).total();
}

CaseResult run(const CaseContext& context) {
  const ParameterSet model = context.model(), oracle = context.set();
  const double circumference = 50 * model.element_length;
  const double turn = 2 * units::pi;
  const double expected = oracle.bond.bend * turn * turn / (2 * circumference);
  const auto error = [&](int n) { return ring_energy(model, n, circumference) / expected - 1; };
  CaseResult result;
  // The energy of a bond bent by delta: (1 - cos delta) + s (12 (1 - cos(delta/2)) - 3 (1 - cos delta)), to
  // delta^4.
  const auto leading = [&](double n) {
    return (3 * shear_share(oracle.bond, circumference / n) / 16 - 1.0 / 12) * turn * turn / (n * n);
  };
  result.check_relative("energy of 50 elements", ring_energy(model, 50, circumference), expected, 2e-3, "eV",
                        "chords and cosines of bends of 0.126 rad: -0.09 %");
  for (const int n : {50, 100})
    result.check_relative(fmt::format("error of {} elements", n), error(n), leading(n), 2e-2, "1",
                          "second order in the element length, apart from shear");
  std::vector<double> elements, errors;
  for (const int n : {16, 20, 25, 32, 40, 50, 64, 80, 100}) {
    elements.push_back(n);
    errors.push_back(100 * error(n));
  }
  result.figure(
      "Error of the bending energy of a ring", {"elements", "", true}, {"error", "%"},
      "Bending energy of a circle of fixed circumference in `N` elements, against `EI (2 pi)^2/(2 L)`. The line is "
      "the leading term of the bond's energy; `s` depends on the shear stiffness of a bond of this length.",
      {theory_curve("(3 s/16 - 1/12) (2 pi/N)^2", 16, 100, [&](double n) { return 100 * leading(n); }),
       model_points("ring of elements", elements, errors)});
  return result;
}

const RegisteredCase registered([] {
  Case c;
  c.name = "ring-energy";
  c.order = 50;
  c.law = Case::Law::none;
  c.run = run;
  c.turns_red = {wrong_EI(1.1)};
  return c;
});

}  // namespace
}  // namespace ropewalk::validate::ring_energy
