// Twist of one tube up to its torsional collapse.
// Atoms: supercells whose period is a lattice vector with a component around the circumference, that is exactly
// periodic, uniformly twisted tubes without ends. Each is minimised with a little noise, so that it may collapse.
// Model: a chain of elements, GJ/2 twist^2 per length.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cases/common/tube_curve.hpp"

namespace ropewalk {
namespace {

// A flattened, twisted ribbon needs a long cell to form.
constexpr double shortest_cell = 9, longest_cell = 24;  // nm
// Shears times radius (nm): collapse is expected near 0.03.
constexpr double first_shear = 0.0075, shear_step = 0.003, last_shear = 0.045;
constexpr ValidatedTube tubes[] = {tube_5_5, tube_10_10};

struct TwistedCell {
  long hexagons = 0;
  double length = 0, twist = 0;  // nm, rad/nm
};

TwistedCell cell_of(Chirality c, const TubeShape& shape, LatticeVector period) {
  TwistedCell cell;
  cell.hexagons = cell_hexagons(c, period);
  cell.length = static_cast<double>(cell.hexagons) * shape.length_per_hexagon;
  cell.twist = -2 * units::pi * period_turns(c, period) / cell.length;
  return cell;
}

// The shortest cell within 2 % of the wanted shear; if there is none, the nearest.
TwistedCell cell_near(Chirality c, const TubeShape& shape, const std::vector<LatticeVector>& periods,
                      double shear) {
  const auto cost = [&](const TwistedCell& cell) {
    const double off = std::abs(cell.twist * shape.radius - shear) / shear;
    return off < 0.02 ? cell.length : 1e6 * off;
  };
  TwistedCell best = cell_of(c, shape, periods.front());
  for (const LatticeVector& period : periods) {
    const TwistedCell cell = cell_of(c, shape, period);
    if (cost(cell) < cost(best)) best = cell;
  }
  return best;
}

std::string twist_input(const Potential& potential, const std::string& data, const std::string& results) {
  std::string text = header_commands("s s p", 0.05) + "read_data " + data + "\n";
  for (const std::string& command : potential.commands) text += command + "\n";
  return text +
         "min_style cg\nmin_modify dmax 0.05 line quadratic\nthermo 200\n"
         "thermo_modify flush yes lost error norm no\n"
         "displace_atoms all random 0.02 0.02 0.02 3001 units box\n"
         "minimize 0.0 2e-4 6000 60000\n" +
         fmt::format("print \"$(pe:%.15g)\" append {}.dat screen no\n", results);
}

void add_rows(const ValidatedTube& tube, MdSession& session, std::vector<std::vector<double>>& rows) {
  const Chirality c = tube.chirality;
  const RelaxedTube relaxed = session.relaxed(c);
  const std::vector<LatticeVector> periods =
      twisted_periods(c, shortest_cell, longest_cell, 1.05 * last_shear / relaxed.shape.radius);
  const std::string name = fmt::format("twist-{}-{}", c.n, c.m);
  std::string input = "# uniformly twisted periodic cells\n";
  std::vector<TwistedCell> cells;
  for (double wanted = first_shear; wanted < last_shear + 0.5 * shear_step; wanted += shear_step) {
    const TwistedCell cell = cell_near(c, relaxed.shape, periods, wanted / relaxed.shape.radius);
    if (!cells.empty() && cell.twist == cells.back().twist) continue;  // no cell is twisted further
    TubeShape shape = relaxed.shape;
    shape.twist = cell.twist;
    const std::string data = fmt::format("{}-{}.data", name, cells.size());
    session.write(data, data_file(tube_atoms(c, shape, cell.hexagons), shape.radius + 1, 0, cell.length));
    input += twist_input(session.potential(), data, name);
    cells.push_back(cell);
  }
  const auto results = session.run(name, input, cells.size(), 1);
  rows.push_back({double(c.n), 0, 0, 0, relaxed.shape.radius});
  for (std::size_t k = 0; k < cells.size(); ++k) {
    const double energy = results[k][0] - static_cast<double>(cells[k].hexagons) * relaxed.energy_per_hexagon;
    rows.push_back({double(c.n), cells[k].twist, energy / cells[k].length, cells[k].length, relaxed.shape.radius});
  }
}

ReferenceTable make_reference(const CaseContext& context) {
  MdSession session(context);
  std::vector<std::vector<double>> rows;
  for (const ValidatedTube& tube : tubes) add_rows(tube, session, rows);
  ReferenceTable t =
      session.table("Energy of one tube (n,n) against twist, uniformly twisted periodic cells", "tube-twist", false,
                    {"n", "twist_rad_per_nm", "energy_eV_per_nm", "cell_nm", "radius_nm"});
  t.rows = rows;
  return t;
}

CaseResult run(const CaseContext& context) {
  CaseResult result;
  const ReferenceTable data = reference(
      context, "tube-twist", 0.02, [&] { return make_reference(context); }, result);
  for (const ValidatedTube& tube : tubes) {
    const ParameterSet set = context.model(tube.set);
    const double radius = set.radius;
    TubeCurve curve;
    curve.tube = tube.name;
    curve.amplitude_name = "shear (radius times twist)";
    for (const double twist : column_where(data, "twist_rad_per_nm", "n", tube.chirality.n))
      curve.amplitude.push_back(radius * twist);
    curve.atoms = column_where(data, "energy_eV_per_nm", "n", tube.chirality.n);
    curve.model = [set, radius](double shear) {
      return chain_energy(set.anharmonic_bond(0), set.element_length, 0, shear / radius, 0);
    };
    curve.end = curve.window = set.validity.twist_collapse;
    add_collapse(curve, curve.amplitude, points_before_collapse(curve.amplitude, curve.atoms),
                 "periodic cells have no held ends; the set's value is that of a tube of 12 nm with held ends",
                 result);
    add_curve(curve, result);
    result.sources.push_back(fmt::format("{} (hash {})", set.name, set.hash));
  }
  result.remarks.push_back(
      "A periodic cell has no held ends, which keep a tube round: its wall flattens from three quarters of the "
      "collapse of 12 nm onwards. The bond of an endless tube has a constant torque from there, and follows the "
      "atoms within 3 % up to twice that twist.");
  return result;
}

const RegisteredCase registered([] {
  Case c;
  c.name = "tube-twist";
  c.group = Case::Group::atoms;
  c.order = 20;
  c.title = "One tube twisted until it collapses";
  c.why = "A rope that turns into a helix trades twist, stored by GJ, for bending.";
  c.setup =
      "Uniformly twisted periodic cells of (5,5) and (10,10), 9 to 24 nm long, with shears up to 0.045 nm/r, "
      "relaxed. The bond was fitted to other cells.";
  c.oracle =
      "Energies of LAMMPS with the Tersoff potential; for a chain of elements U/L = GJ t^2/2 + c4 (r t)^4 up to "
      "the twist at which an "
      "endless tube collapses, and its tangent beyond. Within 1 % up to the collapse of 12 nm.";
  c.literature =
      "B. I. Yakobson, C. J. Brabec, J. Bernholc, Phys. Rev. Lett. 76, 2511 (1996), DOI "
      "10.1103/PhysRevLett.76.2511";
  c.run = run;
  c.turns_red = {wrong_GJ(0.9)};
  c.stays_green = {wrong_EA(1.1), wrong_EI(1.1), wrong_contact(2)};
  return c;
});

}  // namespace
}  // namespace ropewalk
