// The line law of tubes of several walls against sums over their atoms.
#include <fmt/format.h>

#include <cmath>

#include "atoms/lattice.hpp"
#include "cases/common/bundle.hpp"
#include "core/checks.hpp"
#include "model/contact/line_parameters.hpp"

namespace ropewalk::validate::wall_contact {
namespace {

using calibrate::AtomColumn;

// Fixed beforehand, over the well: the fit of the closed form, and the mean over few registries.
constexpr double parallel_tolerance = 4e-3, crossed_tolerance = 6e-3;
constexpr int parallel_registries = 40, crossed_registries = 4;

AtomLaw law_of(const ParameterSet& set) {
  const UniversalLine& atoms = set.law<LineParameters>()->universal;
  if (!(atoms.lj_cutoff > 0)) throw NotApplicable("a sum over atoms needs a cutoff");
  return {atoms.epsilon, atoms.sigma, atoms.lj_cutoff};
}

std::vector<AtomColumn> columns_of(const ParameterSet& set) {
  std::vector<AtomColumn> out;
  for (const Wall& wall : set.walls) {
    const double a = graphene_lattice_constant * wall.radius / tube_radius(wall.chirality);
    const TubeCell cell = tube_cell(wall.chirality, translation_vector(wall.chirality), a);
    AtomColumn column{cell.atoms, static_cast<double>(cell.atoms.size()) / wall.atoms_per_length};
    for (Vector3& atom : column.atoms) atom.z() *= column.period / cell.length;
    out.push_back(column);
  }
  return out;
}

double parallel_of_atoms(const AtomLaw& law, const std::vector<AtomColumn>& walls, double distance) {
  double sum = 0;
  for (const AtomColumn& i : walls)
    for (const AtomColumn& j : walls)
      sum += calibrate::registry_spread({law, law, law}, i, j, distance, parallel_registries).mean;
  return sum;
}

// A piece of a wall as long as the other tube reaches it, turned and shifted.
std::vector<Vector3> piece(const AtomColumn& wall, double half, double turn, double shift) {
  const double c = std::cos(turn), s = std::sin(turn);
  std::vector<Vector3> out;
  for (const Vector3& a : wall.atoms)
    for (double k = std::ceil((-half - a.z() - shift) / wall.period); a.z() + shift + k * wall.period < half; ++k)
      out.emplace_back(c * a.x() - s * a.y(), s * a.x() + c * a.y(), a.z() + shift + k * wall.period);
  return out;
}

double crossed_of_atoms(const AtomLaw& law, const std::vector<AtomColumn>& walls, double radius, double distance) {
  const double half = law.cutoff + radius, reach2 = law.cutoff * law.cutoff;
  double sum = 0;
  for (int n = 1; n <= crossed_registries; ++n) {
    const auto [turn_i, turn_j, shift] = calibrate::registry_parts(n);
    for (const AtomColumn& i : walls)
      for (const AtomColumn& j : walls) {
        const std::vector<Vector3> first = piece(i, half, 2 * units::pi * turn_i, shift * i.period),
                                   second = piece(j, half, 2 * units::pi * turn_j, shift * j.period);
        for (const Vector3& p : first)
          for (const Vector3& q : second) {
            const double x = distance + q.x() - p.x(), y = q.z() - p.y(), z = -q.y() - p.z();
            const double d2 = x * x + y * y + z * z;
            if (d2 < reach2) sum += law.energy(std::sqrt(d2));
          }
      }
  }
  return sum / crossed_registries;
}

CaseResult run(const CaseContext& context) {
  CaseResult result;
  for (const CaseTube& tube : context.tubes()) {
    if (tube.set.walls.empty()) throw NotApplicable("the set is that of one wall");
    const AtomLaw law = law_of(tube.set);
    const std::vector<AtomColumn> walls = columns_of(tube.set);
    const LineDensity& model = tube.model.law<LineParameters>()->density;
    const Well well = pair_well(tube.set);
    std::vector<double> gap, of_atoms, of_model;
    double largest = 0;
    for (const double beyond : {-0.03, 0.0, 0.03, 0.06, 0.1, 0.2, 0.35, 0.5}) {
      const double distance = well.distance + beyond;
      gap.push_back(distance);
      of_atoms.push_back(parallel_of_atoms(law, walls, distance));
      of_model.push_back(line_parallel_energy(model, distance));
      largest = std::max(largest, std::fabs(of_model.back() - of_atoms.back()));
    }
    result.check_absolute(tube.name + ": parallel, largest difference over the well", largest / -well.energy, 0,
                          parallel_tolerance, "1");
    const Well across = surface_integral(tube.set).crossed_well();
    for (const double beyond : {0.0, 0.1, 0.3}) {
      if (context.brief && beyond > 0) break;
      const double atoms = crossed_of_atoms(law, walls, tube.set.radius, across.distance + beyond);
      result.check_absolute(
          fmt::format("{}: crossed, {:.1f} nm beyond the well, over the well", tube.name, beyond),
          (line_crossed_energy(model, across.distance + beyond, 0.5 * units::pi) - atoms) / across.energy, 0,
          crossed_tolerance, "1");
    }
    ChartLine points{"sum over atoms", gap, of_atoms, 0};
    points.points = true;
    result.figure(fmt::format("Two parallel {} tubes", tube.name), {"distance of the axes", "nm"},
                  {"energy per length", "eV/nm"}, "Mean over registries, and the line law of the set.",
                  {{"model", gap, of_model, 1}, points});
  }
  return result;
}

const RegisteredCase registered([] {
  Case c;
  c.name = "wall-contact";
  c.order = 75;
  c.sets = {"cnt-5-5@10-10-tersoff"};
  c.run = run;
  c.turns_red = {{wrong_contact(1.02), {"parallel", "crossed"}}};
  c.stays_green = {wrong_EA(1.1), wrong_EI(1.1)};
  return c;
});

}  // namespace
}  // namespace ropewalk::validate::wall_contact
