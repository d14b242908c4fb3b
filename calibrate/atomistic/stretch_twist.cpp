// Stretch and twist by exactly periodic cells: relaxation of the tube, and the table of cells.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>

#include "atomistic/runs.hpp"
#include "io/files.hpp"

namespace ropewalk::calibrate {
namespace {

using units::pi;
constexpr double skin = 0.04;                // nm; nothing moves far in these cells
constexpr double relaxed_graphene = 0.2485;  // nm: lattice constant of carbon with which a relaxation begins

// All atoms of a uniform cell are equivalent: the minimiser effectively varies three numbers (radius and inner
// shift) and converges to rounding in some tens of steps.
constexpr const char* minimiser =
    "min_style cg\n"
    "min_modify dmax 0.02 line quadratic\n";

std::string report(const std::string& name, const char* values) {
  return fmt::format("print \"{}\" append {}.dat screen no\n", values, name);
}

// The shortest cell whose shear is close to the wanted one; otherwise the closest cell.
LatticeVector cell_near(Chirality c, double shear, double tolerance, double min_length, double a) {
  // Shears on the lattice are fine enough that one of these lengths is close.
  const double step = a;
  const double longest = std::max(1.3 * min_length, 2.5 * step / std::max(std::abs(shear), tolerance));
  const double radius = tube_radius(c, a);
  const std::vector<LatticeVector> periods =
      twisted_periods(c, min_length, std::max(longest, min_length + 1.01 * step * std::sqrt(3.0)),
                      std::abs(shear) + 4 * tolerance, a);
  const auto shear_of = [&](const LatticeVector& v) {
    return -2 * pi * radius * period_turns(c, v) /
           (static_cast<double>(cell_hexagons(c, v)) * rolled_shape(c, a).length_per_hexagon);
  };
  const LatticeVector* best = nullptr;
  const auto cost = [&](const LatticeVector& v) {
    const double off = std::abs(shear_of(v) - shear);
    return off <= tolerance ? static_cast<double>(cell_hexagons(c, v)) : 1e9 * (1 + off);
  };
  for (const LatticeVector& v : periods)
    if (!best || cost(v) < cost(*best)) best = &v;
  if (!best) throw std::invalid_argument("no lattice vector serves as the period of this tube");
  return *best;
}

// Mean displacement of the second sublattice against the first, from where `shape` places them. The mirror of an
// armchair tube keeps the one of the two, that of a zigzag tube the other at 0. A twofold axis, which swaps the
// sublattices of one species, keeps the lift at 0.
void find_inner_shift(Chirality c, const std::vector<Site>& sites, const std::vector<Vector3>& atoms,
                      bool one_species, TubeShape& shape) {
  const double length = static_cast<double>(sites.size() / 2) * shape.length_per_hexagon;
  double arc[2] = {0, 0}, height[2] = {0, 0}, radius[2] = {0, 0};
  for (std::size_t i = 0; i < sites.size(); ++i) {
    const Vector3 rolled = place(c, sites[i], shape);
    const double turned = std::atan2(rolled.x() * atoms[i].y() - rolled.y() * atoms[i].x(),
                                     rolled.x() * atoms[i].x() + rolled.y() * atoms[i].y());
    arc[sites[i].second] += turned;
    height[sites[i].second] += std::remainder(atoms[i].z() - rolled.z(), length);
    radius[sites[i].second] += std::hypot(atoms[i].x(), atoms[i].y());
  }
  const double per_atom = 2.0 / static_cast<double>(sites.size());
  shape.arc_shift = c.n == 0 || c.m == 0 ? 0 : (arc[1] - arc[0]) * per_atom;
  shape.height_shift = c.n == c.m ? 0 : (height[1] - height[0]) * per_atom;
  shape.lift = one_species ? 0 : (radius[1] - radius[0]) * per_atom;
}

// The rolled sheet is within 10 % of every relaxed tube. A potential without this minimum may give any result.
void check_still_a_tube(const RunContext& run, double radius_ratio, double length_ratio) {
  if (std::abs(radius_ratio - 1) < 0.25 && std::abs(length_ratio - 1) < 0.15) return;
  throw LammpsError(
      fmt::format("potential '{}' does not hold ({},{}): relaxed, its radius is {:.3g} and its length {:.3g} "
                  "times that of the rolled sheet; check the potential ({}/relax.log)",
                  run.potential.name, run.c.n, run.c.m, radius_ratio, length_ratio, run.folder));
}

constexpr double shortest_cell = 1.0;  // nm; three times any bonded cutoff, so that no atom meets its own image

// A flattened, twisted ribbon needs a long cell to form.
constexpr double collapse_cell = 9, longest_collapse_cell = 24;  // nm

}  // namespace

std::string uniform_cell_commands(const Potential& potential, const std::string& data) {
  std::string text = header_commands("s s p", skin) + fmt::format("read_data {}\n", data);
  for (const std::string& command : potential.commands) text += command + "\n";
  text += minimiser;
  text +=
      "variable rho atom sqrt(x*x+y*y)\n"
      "variable new_x atom x*v_wide\n"
      "variable new_y atom y*v_wide\n"
      "compute rho all reduce ave v_rho\n"
      "thermo_style custom step pe fnorm fmax c_rho lz\n"
      "thermo 50\n"
      "thermo_modify flush yes lost error norm no format float %.12g\n";
  return text;
}

LatticeVector untwisted_cell(Chirality c, double min_length, double a) {
  const LatticeVector t = translation_vector(c);
  const double length = translational_period(c, a);
  const int copies = std::max(1, static_cast<int>(std::ceil(min_length / length - 1e-9)));
  // A tube with a long period gets a cell with a very small twist instead.
  if (length > std::max(8.0, 2 * min_length)) return cell_near(c, 0, 2e-4, min_length, a);
  return {copies * t.p, copies * t.q};
}

RelaxedTube relax_tube(RunContext& run) {
  const Chirality c = run.c;
  const Honeycomb& honeycomb = run.potential.honeycomb;
  const double a = honeycomb.lattice_constant;
  const LatticeVector period = untwisted_cell(c, std::max(shortest_cell, 2 * run.potential.cutoff), a);
  const long hexagons = cell_hexagons(c, period);
  TubeShape shape = rolled_shape(c, honeycomb.carbon() ? relaxed_graphene : a);
  const double length = static_cast<double>(hexagons) * shape.length_per_hexagon;
  shape.twist = -2 * pi * period_turns(c, period) / length;
  const std::vector<Site> sites = strip_sites(c, hexagons);
  write_data(run, "relax.data", data_file({tube_atoms(c, shape, hexagons)}, shape.radius + 0.5, 0, length, honeycomb));

  const std::string values = report("relax", "$(pe:%.15g) $(fnorm:%.6g) $(lz:%.15g) $(c_rho:%.15g)");
  run_stage(run, "relax",
            "# the free tube: radius, length and inner shift; then once stretched, for its contraction\n" +
                uniform_cell_commands(run.potential, "relax.data") +
                "fix cell all box/relax z 0.0 vmax 0.002\n"
                "minimize 0.0 1e-7 2000 20000\n"
                "unfix cell\n"
                "minimize 0.0 1e-9 500 5000\n" +
                values +
                "write_dump all custom relax.atoms id x y z modify sort id format float %.12f\n"
                "change_box all z scale 1.005 remap units box\n"
                "minimize 0.0 1e-7 500 5000\n" +
                values);
  const auto result = read_results(run.folder, "relax", 2, 2, 4);

  check_still_a_tube(run, result[0][3] * angstrom / shape.radius, result[0][2] * angstrom / length);

  RelaxedTube tube;
  tube.shape = shape;
  tube.shape.radius = result[0][3] * angstrom;
  tube.shape.length_per_hexagon = result[0][2] * angstrom / static_cast<double>(hexagons);
  tube.shape.twist = shape.twist * length / (result[0][2] * angstrom);
  tube.energy_per_hexagon = result[0][0] / static_cast<double>(hexagons);
  tube.contraction = -std::log(result[1][3] / result[0][3]) / std::log(1.005);
  find_inner_shift(c, sites, read_atoms(run, "relax.atoms", sites.size()), honeycomb.one_species(), tube.shape);
  return tube;
}

void move_inner_shift(RunContext& run, double shear, TubeShape& shape) {
  const Chirality c = run.c;
  if (!c.chiral() || shape.twist == 0) return;
  const Honeycomb& honeycomb = run.potential.honeycomb;
  const LatticeVector period = cell_near(c, std::copysign(shear, shape.twist), 0.1 * shear,
                                         std::max(shortest_cell, 2 * run.potential.cutoff), honeycomb.lattice_constant);
  const long hexagons = cell_hexagons(c, period);
  TubeShape twisted = shape;
  const double length = static_cast<double>(hexagons) * shape.length_per_hexagon;
  twisted.twist = -2 * pi * period_turns(c, period) / length;
  const double part = shape.twist / twisted.twist;
  const std::vector<Site> sites = strip_sites(c, hexagons);
  write_data(run, "shift.data", data_file({tube_atoms(c, twisted, hexagons)}, shape.radius + 0.5, 0, length, honeycomb));
  run_stage(run, "shift",
            "# a twisted cell, for its inner shift\n" + uniform_cell_commands(run.potential, "shift.data") +
                "minimize 0.0 1e-9 2000 20000\n"
                "write_dump all custom shift.atoms id x y z modify sort id format float %.12f\n");
  // The atoms began at the shift of the untwisted cell: what is found is the change.
  find_inner_shift(c, sites, read_atoms(run, "shift.atoms", sites.size()), honeycomb.one_species(), twisted);
  shape.arc_shift += part * twisted.arc_shift;
  shape.height_shift += part * twisted.height_shift;
}

CellGrid elastic_grid(const StiffnessOptions& options) {
  CellGrid grid{"stretch-twist", {}, options.largest_shear, {-1, -0.5, 0, 0.5, 1}};
  for (int k = -3; k <= 3; ++k) grid.strains.push_back(options.largest_strain * k / 3);
  return grid;
}

CellGrid wide_grid(Chirality c, const Envelope& limits) {
  const double strain = limits.compression.value;
  CellGrid grid{"wide-stretch-twist", {}, limits.twist_collapse.value, {0, 0.4, 0.7, 1}};
  if (c.chiral()) grid.parts_of_shear = {-1, -0.7, -0.4, 0, 0.4, 0.7, 1};
  for (int k = -4; k <= 4; ++k) grid.strains.push_back(strain * k / 4);
  return grid;
}

std::vector<LatticeVector> stretch_twist_periods(Chirality c, const Potential& potential,
                                                 const StiffnessOptions& options, const CellGrid& grid) {
  const double min_length = std::max({shortest_cell, 2 * potential.cutoff, options.cell_length});
  const double a = potential.honeycomb.lattice_constant;
  std::vector<LatticeVector> periods;
  for (const double part : grid.parts_of_shear)
    periods.push_back(part == 0
                          ? untwisted_cell(c, min_length, a)
                          : cell_near(c, part * grid.largest_shear, 0.1 * grid.largest_shear, min_length, a));
  return periods;
}

std::vector<CellResult> stretch_twist_cells(RunContext& run, const RelaxedTube& start, const CellGrid& grid) {
  const Chirality c = run.c;
  const std::vector<LatticeVector> periods = stretch_twist_periods(c, run.potential, run.options, grid);

  std::string input = "# relaxed cells: every twist (one cell each) at several strains\n";
  std::vector<CellResult> cells;
  for (std::size_t k = 0; k < periods.size(); ++k) {
    const long hexagons = cell_hexagons(c, periods[k]);
    const double angle = -2 * pi * period_turns(c, periods[k]);
    const double free_length = static_cast<double>(hexagons) * start.shape.length_per_hexagon;
    const std::string data = fmt::format("{}-{}.data", grid.name, k);
    for (const double strain : grid.strains) {
      CellResult cell;
      cell.hexagons = hexagons;
      cell.angle = angle;
      cell.length = free_length * (1 + strain);
      if (strain == grid.strains.front()) {
        TubeShape shape = start.shape;
        shape.length_per_hexagon *= 1 + strain;
        shape.radius *= 1 - start.contraction * strain;
        shape.twist = angle / cell.length;
        write_data(run, data, data_file({tube_atoms(c, shape, hexagons)}, shape.radius + 0.5, 0, cell.length,
                                        run.potential.honeycomb));
        input += uniform_cell_commands(run.potential, data);
      } else {
        const double step = cell.length / cells.back().length - 1;
        input += fmt::format(
            "change_box all z final 0.0 {:.12f} remap units box\n"
            "variable wide delete\nvariable wide equal {:.12f}\n"
            "set group all x v_new_x y v_new_y\n",
            cell.length / angstrom, 1 - start.contraction * step);
      }
      input += "minimize 0.0 1e-5 300 3000\n";
      input += report(grid.name, "$(pe:%.15g) $(fnorm:%.6g) $(lz:%.15g) $(c_rho:%.15g)");
      cells.push_back(cell);
    }
  }
  run_stage(run, grid.name, input);
  const auto results = read_results(run.folder, grid.name, cells.size(), cells.size(), 4);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    cells[i].energy = results[i][0];
    cells[i].force = results[i][1] / angstrom;
    cells[i].length = results[i][2] * angstrom;
    cells[i].radius = results[i][3] * angstrom;
  }
  return cells;
}

std::vector<AtomisticRow> stretch_twist_rows(const std::vector<CellResult>& cells, const RelaxedTube& tube,
                                             const CellGrid& grid) {
  std::vector<AtomisticRow> rows;
  for (const CellResult& cell : cells) {
    AtomisticRow row;
    row.kind = grid.name;
    row.length = static_cast<double>(cell.hexagons) * tube.shape.length_per_hexagon;
    row.strain = cell.length / row.length - 1;
    row.twist = cell.angle / row.length;
    row.atoms = static_cast<int>(2 * cell.hexagons);
    row.energy = cell.energy - static_cast<double>(cell.hexagons) * tube.energy_per_hexagon;
    row.radius = cell.radius;
    rows.push_back(row);
  }
  return rows;
}

std::vector<AtomisticRow> collapse_rows(RunContext& run, const RelaxedTube& tube,
                                        const std::vector<double>& shears) {
  const Chirality c = run.c;
  const double radius = tube.shape.radius;
  const std::vector<LatticeVector> periods =
      twisted_periods(c, collapse_cell, longest_collapse_cell, 1.05 * shears.back() / radius,
                      run.potential.honeycomb.lattice_constant);
  std::string input = "# twisted cells with a little noise, which may collapse\n";
  std::vector<AtomisticRow> rows;
  for (const double shear : shears) {
    const TwistedCell cell = twisted_cell_near(c, tube.shape, periods, shear / radius);
    AtomisticRow row;
    row.kind = "collapse-twist";
    row.length = cell.length;
    row.twist = cell.twist;
    row.atoms = static_cast<int>(2 * cell.hexagons);
    if (!rows.empty() && row.twist == rows.back().twist) continue;  // no cell is twisted further
    TubeShape shape = tube.shape;
    shape.twist = row.twist;
    const std::string data = fmt::format("collapse-{}.data", rows.size());
    write_data(run, data, data_file({tube_atoms(c, shape, cell.hexagons)}, radius + 1, 0, row.length,
                                    run.potential.honeycomb));
    input += cell_commands(run.potential, data) +
             fmt::format("displace_atoms all random 0.02 0.02 0.02 {} units box\nminimize 0.0 2e-4 6000 60000\n",
                         3001 + rows.size());
    input += report("collapse", "$(pe:%.15g) $(fnorm:%.6g)");
    rows.push_back(row);
  }
  run_stage(run, "collapse", input);
  const auto results = read_results(run.folder, "collapse", rows.size(), rows.size(), 2);
  for (std::size_t i = 0; i < rows.size(); ++i)
    rows[i].energy = results[i][0] - 0.5 * rows[i].atoms * tube.energy_per_hexagon;
  return rows;
}

}  // namespace ropewalk::calibrate
