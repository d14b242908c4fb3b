// Twist of one tube up to its torsional collapse.
// Atoms: supercells whose period is a lattice vector with a component around the circumference, that is exactly
// periodic, uniformly twisted tubes without ends. Each is minimised with a little noise, so that it may collapse.
// Model: a chain of elements, GJ/2 twist^2 per length.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cases/common/tube_curve.hpp"

namespace ropewalk::validate::tube_twist {
namespace {

// A flattened, twisted ribbon needs a long cell to form.
constexpr double beyond_tolerance = 0.03;               // fixed beforehand: what the fit of the collapse leaves
constexpr double shortest_cell = 9, longest_cell = 24;  // nm
// Shears times radius (nm): collapse is expected near 0.03.
constexpr double first_shear = 0.0075, shear_step = 0.003, last_shear = 0.045;

std::string twist_input(const Potential& potential, const std::string& data, const std::string& results) {
  return calibrate::cell_commands(potential, data) +
         "displace_atoms all random 0.02 0.02 0.02 3001 units box\n"
         "minimize 0.0 2e-4 6000 60000\n" +
         fmt::format("print \"$(pe:%.15g)\" append {}.dat screen no\n", results);
}

// Shears from rest to the collapse; for chiral tubes in either sense.
std::vector<double> shears(Chirality c) {
  std::vector<double> list;
  for (double wanted = first_shear; wanted < last_shear + 0.5 * shear_step; wanted += shear_step) {
    list.push_back(wanted);
    if (c.chiral()) list.insert(list.begin(), -wanted);
  }
  return list;
}

ReferenceTable make_reference(const CaseContext& context, const ParameterSet& set) {
  MdSession session(context, set);
  const Chirality c = set.chirality;
  const RelaxedTube& relaxed = session.relaxed();
  const std::vector<LatticeVector> periods =
      twisted_periods(c, shortest_cell, longest_cell, 1.05 * last_shear / relaxed.shape.radius,
                      set.honeycomb.lattice_constant);
  std::string input = "# uniformly twisted periodic cells\n";
  std::vector<TwistedCell> cells;
  for (const double wanted : shears(c)) {
    const auto cell =
        twisted_cell_near(c, relaxed.shape, periods, wanted / (relaxed.shape.radius * relaxed.shape.radius));
    if (!cells.empty() && cell.twist == cells.back().twist) continue;  // no cell is twisted further
    TubeShape shape = relaxed.shape;
    shape.twist = cell.twist;
    const std::string data = fmt::format("twist-{}.data", cells.size());
    session.write(data, data_file({tube_atoms(c, shape, cell.hexagons)}, shape.radius + 1, 0, cell.length,
                                    session.potential().honeycomb));
    input += twist_input(session.potential(), data, "twist");
    cells.push_back(cell);
  }
  const auto results = session.run("twist", input, cells.size(), 1);
  ReferenceTable t =
      session.table(fmt::format("Energy of one {} tube against twist, uniformly twisted periodic cells, above the "
                                "tube that is not twisted",
                                tube_name(set)),
                    "tube-twist", false, {"twist_rad_per_nm", "energy_eV_per_nm", "cell_nm", "radius_nm"});
  const auto add = [&](double twist, double energy, double length) {
    t.rows.push_back({twist, energy, length, relaxed.shape.radius});
  };
  bool rest = false;
  for (std::size_t k = 0; k < cells.size(); ++k) {
    if (!rest && cells[k].twist > 0) add(0, 0, 0);
    rest = rest || cells[k].twist > 0;
    const double energy = results[k][0] - static_cast<double>(cells[k].hexagons) * relaxed.energy_per_hexagon;
    add(cells[k].twist, energy / cells[k].length, cells[k].length);
  }
  return t;
}

// The twist counts from the natural one of the tube, at which the bond is at rest; the energy from that there.
TubeCurve curve_of(const CaseTube& tube, const ReferenceTable& data) {
  const double radius = tube.set.radius, natural = natural_twist(tube.set);
  const auto energy = [radius](const ParameterSet& set, double shear) {
    return chain_energy(set.anharmonic_bond(0), set.element_length, 0, shear / radius, 0);
  };
  TubeCurve curve;
  curve.tube = tube.name;
  curve.amplitude_name = "shear (radius times twist)";
  for (const double twist : data.column("twist_rad_per_nm")) curve.amplitude.push_back(radius * (twist - natural));
  curve.atoms = data.column("energy_eV_per_nm");
  for (double& atoms : curve.atoms) atoms += energy(tube.set, -radius * natural);
  curve.model = [energy, model = tube.model](double shear) { return energy(model, shear); };
  curve.end = tube.set.validity.twist_collapse;
  curve.window = tube.set.validity.endless_collapse > 0 ? tube.set.validity.endless_collapse : curve.end;
  return curve;
}

// The points of one sense of the twist, from rest.
void add_collapse_of_sense(const TubeCurve& curve, double sense, CaseResult& result) {
  std::vector<std::pair<double, double>> points;
  for (std::size_t k = 0; k < curve.amplitude.size(); ++k)
    if (sense * curve.amplitude[k] > -1e-9) points.emplace_back(sense * curve.amplitude[k], curve.atoms[k]);
  std::sort(points.begin(), points.end());
  std::vector<double> shear, energy;
  for (const auto& [x, y] : points) shear.push_back(x), energy.push_back(y);
  add_collapse(curve, shear, points_before_collapse(shear, energy),
               "periodic cells have no held ends; the set's value is that of a tube of 12 nm with held ends",
               result);
}

// Between the collapse of an endless tube, from which the torque of the bond is constant, and that of 12 nm.
void add_beyond(const TubeCurve& curve, CaseResult& result) {
  Check worst;
  worst.name = curve.tube + ": energy between the collapse of an endless tube and that of 12 nm";
  worst.unit = "eV/nm";
  worst.tolerance = beyond_tolerance;
  for (std::size_t k = 0; k < curve.amplitude.size(); ++k) {
    const double shear = std::abs(curve.amplitude[k]);
    if (shear < curve.window || shear > curve.end) continue;
    Check check = worst;
    check.value = curve.model(curve.amplitude[k]);
    check.reference = curve.atoms[k];
    check.note = fmt::format("the point of largest difference, at {:.3g}", curve.amplitude[k]);
    if (worst.note.empty() || std::abs(check.difference()) > std::abs(worst.difference())) worst = check;
  }
  if (!worst.note.empty()) result.checks.push_back(worst);
}

void compare(const CaseTube& tube, const ReferenceTable& data, CaseResult& result) {
  const TubeCurve curve = curve_of(tube, data);
  add_collapse_of_sense(curve, 1, result);
  if (tube.set.chirality.chiral()) add_collapse_of_sense(curve, -1, result);
  add_curve(curve, result);
  if (curve.window < curve.end) add_beyond(curve, result);
}

const RegisteredCase registered([] {
  Case c = tube_curve_case("tube-twist", 0.02, make_reference, compare);
  c.order = 20;
  c.lammps_seconds = [](const ParameterSet& set) {
    return lammps_seconds(set, 2 * shortest_cell, static_cast<double>(shears(set.chirality).size()));
  };
  c.turns_red = {wrong_GJ(0.9)};
  c.stays_green = {wrong_EA(1.1), wrong_EI(1.1), wrong_contact(2)};
  return c;
});

}  // namespace
}  // namespace ropewalk::validate::tube_twist
