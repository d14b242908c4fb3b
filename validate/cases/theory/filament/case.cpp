// Filaments without a lattice: a beam that buckles, and two that are pulled apart.
#include <fmt/format.h>

#include <cmath>

#include "cases/common/peeled_pair.hpp"
#include "model/contact/line_parameters.hpp"

namespace ropewalk::validate::filament {
namespace {

constexpr int bonds = 40;

void check_buckling(const CaseTube& tube, CaseResult& result) {
  const double length = bonds * tube.set.element_length;
  const double euler = std::pow(units::pi / length, 2) * tube.set.bond.bend;
  result.check_relative("critical load of " + tube.name, buckling_load(tube.model, bonds, euler), euler, 5e-3, "eV/nm",
                        "40 bonds; the column shortens by `P/EA` before it buckles");
}

// Ends of beams that balance the adhesion part by w over a crack of (9 EI w^2/Gamma)^(1/4).
void check_zipper(const CaseTube& tube, CaseResult& result, std::vector<double>& openings,
                  std::vector<double>& released) {
  const double adhesion = -pair_well(tube.set).energy, reach = tube.set.law<LineParameters>()->density.cutoff_gap;
  for (const double part : {1.0, 2.0}) {
    const double w = part * reach, crack = std::pow(9 * tube.set.bond.bend * w * w / adhesion, 0.25);
    const Peel p = peel(tube.model, w, crack);
    openings.push_back(w);
    released.push_back(p.release / adhesion);
    result.check_relative(fmt::format("2 F sin(slope) of {}, opened by {:.1f} nm each", tube.name, w), p.release, adhesion,
                          1e-2, "eV/nm", "exact for any shape, as long as the ends are beyond the contact");
  }
}

CaseResult run(const CaseContext& context) {
  CaseResult result;
  std::vector<ChartLine> lines = {theory_curve("adhesion of the pair", 1.5, 4.5, [](double) { return 1.0; })};
  for (const CaseTube& tube : context.tubes()) {
    check_buckling(tube, result);
    std::vector<double> openings, released;
    check_zipper(tube, result, openings, released);
    lines.push_back(model_points(tube.name, openings, released));
  }
  result.figure("Energy released by peeling two filaments", {"opening of each end", "nm"},
                {"energy per length over adhesion", ""},
                "The work of the end forces per length of contact lost, from force and slope at the ends.", lines);
  return result;
}

const RegisteredCase registered([] {
  Case c;
  c.name = "filament";
  c.order = 85;
  c.sets = {"cellulose-36", "f-actin"};
  c.run = run;
  c.turns_red = {{wrong_EI(1.1), {"critical load"}}, {wrong_contact(2), {"2 F sin(slope)"}}};
  c.stays_green = {wrong_GJ(1.1)};
  return c;
});

}  // namespace
}  // namespace ropewalk::validate::filament
