// A tube that is pulled beyond the window of its anharmonic terms, until it gives way.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>

#include "atomistic/runs.hpp"
#include "io/files.hpp"

namespace ropewalk::calibrate {
namespace {

constexpr double least_length = 1.0;  // nm, as of the other uniform cells
constexpr int most_pulls = 120;
constexpr double falls_to = 0.98;  // of the work of the step before: LAMMPS goes no farther
constexpr int stencil = 5;         // rows that give the force at a strain

// The longest of the bonds of an atom: each has three.
double longest_bond(const std::vector<Vector3>& atoms, double period) {
  double longest = 0;
  for (const Vector3& a : atoms) {
    std::array<double, 4> nearest;  // itself, and three more
    nearest.fill(1e300);
    for (const Vector3& b : atoms) {
      Vector3 d = b - a;
      d.z() = std::remainder(d.z(), period);
      const double square = d.squaredNorm();
      if (square >= nearest.back()) continue;
      nearest.back() = square;
      std::sort(nearest.begin(), nearest.end());
    }
    longest = std::max(longest, nearest.back());
  }
  return std::sqrt(longest);
}

// All frames of a dump, atoms in the order of their ids (nm).
std::vector<std::vector<Vector3>> read_frames(const std::string& path) {
  std::istringstream lines(read_file(path));
  std::vector<std::vector<Vector3>> frames;
  bool atoms = false;
  for (std::string line; std::getline(lines, line);) {
    if (line.rfind("ITEM:", 0) == 0) {
      atoms = line.rfind("ITEM: ATOMS", 0) == 0;
      if (atoms) frames.emplace_back();
      continue;
    }
    std::istringstream words(line);
    long id = 0;
    double x = 0, y = 0, z = 0;
    if (atoms && words >> id >> x >> y >> z) frames.back().push_back(Vector3(x, y, z) * angstrom);
  }
  return frames;
}

// Derivative at x of the polynomial through the points first .. first + stencil - 1.
double slope_through(const std::vector<AtomisticRow>& rows, std::size_t first, double x) {
  double sum = 0;
  for (std::size_t i = first; i < first + stencil; ++i)
    for (std::size_t k = first; k < first + stencil; ++k) {
      if (k == i) continue;
      double term = rows[i].energy / (rows[i].strain - rows[k].strain);
      for (std::size_t j = first; j < first + stencil; ++j)
        if (j != i && j != k) term *= (x - rows[j].strain) / (rows[i].strain - rows[j].strain);
      sum += term;
    }
  return sum;
}

// Energy over length against strain, and what one stencil farther inside makes of it.
Measured force_at(const std::vector<AtomisticRow>& rows, double strain) {
  std::size_t nearest = 0;
  for (std::size_t i = 0; i < rows.size(); ++i)
    if (std::fabs(rows[i].strain - strain) < std::fabs(rows[nearest].strain - strain)) nearest = i;
  const std::size_t half = stencil / 2, first = std::min(nearest - std::min(nearest, half), rows.size() - stencil);
  const double length = rows.front().length, force = slope_through(rows, first, strain) / length;
  const double other = slope_through(rows, first > 0 ? first - 1 : first + 1, strain) / length;
  return {force, std::fabs(force - other)};
}

}  // namespace

PulledCell pull_cell(RunContext& run, const RelaxedTube& tube) {
  const Chirality c = run.c;
  const LatticeVector period =
      untwisted_cell(c, std::max({least_length, 2 * run.potential.cutoff, run.options.cell_length}),
                     run.potential.honeycomb.lattice_constant);
  const long hexagons = cell_hexagons(c, period);
  const double angle = -2 * units::pi * period_turns(c, period),
               length = static_cast<double>(hexagons) * tube.shape.length_per_hexagon;
  TubeShape shape = tube.shape;
  shape.twist = angle / length;
  write_data(run, "pull.data", data_file({tube_atoms(c, shape, hexagons)}, shape.radius + 0.5, 0, length,
                                          run.potential.honeycomb));
  const std::string relaxed =
      "minimize 0.0 1e-5 1000 10000\n"
      "print \"$(pe:%.15g)\" append pull.dat screen no\n"
      "write_dump all custom pull.atoms id x y z modify sort id append yes format float %.9f\n";
  std::string input = "# one cell, pulled in steps until its force falls\n" +
                      uniform_cell_commands(run.potential, "pull.data") +
                      fmt::format("variable wide equal {:.12f}\n", 1 - tube.contraction * pull_step) + relaxed +
                      "variable e equal $(pe:%.15g)\nvariable last equal 0.0\n";
  for (int k = 1; k <= most_pulls; ++k)
    input += fmt::format(
                 "change_box all z final 0.0 {:.12f} remap units box\n"
                 "set group all x v_new_x y v_new_y\n",
                 length * (1 + k * pull_step) / angstrom) +
             relaxed +
             fmt::format(
                 "variable work equal $(pe-v_e:%.15g)\n"
                 "if \"${{work}} < $({}*v_last:%.15g)\" then \"jump SELF gave_way\"\n"
                 "variable last delete\nvariable last equal ${{work}}\n"
                 "variable work delete\nvariable e delete\nvariable e equal $(pe:%.15g)\n",
                 falls_to);
  run_stage(run, "pull", input + "label gave_way\n");
  const auto results = read_results(run.folder, "pull", 3, most_pulls + 1, 1);
  const auto frames = read_frames(run.folder + "/pull.atoms");
  if (frames.size() != results.size() || frames.back().size() != frames.front().size())
    throw LammpsError(fmt::format("LAMMPS left {} of {} states of the pull in {}; the disk may be full",
                                  frames.size(), results.size(), run.folder));

  PulledCell out;
  out.ended_by = "it was pulled no farther";
  for (std::size_t k = 0; k < results.size(); ++k) {
    AtomisticRow row;
    row.kind = "pull";
    row.length = length;
    row.strain = pull_step * static_cast<double>(k);
    row.twist = angle / length;
    row.atoms = static_cast<int>(2 * hexagons);
    row.energy = results[k][0] - static_cast<double>(hexagons) * tube.energy_per_hexagon;
    for (const Vector3& atom : frames[k]) row.radius += std::hypot(atom.x(), atom.y());
    row.radius /= static_cast<double>(frames[k].size());
    if (run.potential.inner > 0 && longest_bond(frames[k], length * (1 + row.strain)) > run.potential.inner) {
      out.ended_by = fmt::format("a bond would be longer than {:.3g} nm, from where the potential cuts bonds off",
                                 run.potential.inner);
      break;
    }
    if (k > 1 && row.energy - out.rows[k - 1].energy < out.rows[k - 1].energy - out.rows[k - 2].energy) {
      out.ended_by = "the force falls";
      break;
    }
    out.rows.push_back(row);
  }
  if (!(run.potential.inner > 0))
    run.warnings.push_back("where this potential cuts bonds off is not known: the end of the pull may be too high");
  return out;
}

Pull PullFit::law() const {
  Pull out;
  out.end = end;
  out.edge_force = edge_force;
  for (std::size_t k = 0; k < force.size(); ++k) out.force[k] = force[k].value;
  return out;
}

PullFit fit_pull(std::vector<AtomisticRow>& table, const Anharmonic& law, double EA, double GJ,
                 double natural_twist) {
  std::vector<AtomisticRow> rows;
  for (const AtomisticRow& row : table)
    if (row.kind == "pull") rows.push_back(row);
  constexpr double least = 0.02;  // smallest strain beyond the window
  if (rows.size() < stencil + 1 || rows.back().strain < law.max_strain + least) return {};
  const double twist = rows.front().twist - natural_twist;
  PullFit out;
  out.start = law.max_strain, out.end = rows.back().strain;
  out.edge_force = edge_of_window(law, EA).force;
  for (std::size_t k = 0; k < out.force.size(); ++k) {
    const double strain = law.max_strain + (out.end - law.max_strain) * static_cast<double>(k) / PULL_STEPS;
    out.force[k] = force_at(rows, strain);
    // The cell is twisted against the tube at rest where that has a natural twist.
    out.force[k].value -= strain_energy(law, strain, twist).by_strain - strain_energy(law, strain, 0).by_strain;
  }
  Anharmonic whole = law;
  set_pull(whole, EA, out.law());
  const auto energy = [&](double strain) {
    return 0.5 * EA * strain * strain + twist_energy(whole, GJ, twist).energy +
           strain_energy(whole, strain, twist).energy + stretch_beyond(whole, EA, strain).energy;
  };
  const double most = rows.back().energy - rows.front().energy;
  for (AtomisticRow& row : table) {
    if (row.kind != "pull") continue;
    row.residual =
        row.energy - rows.front().energy - row.length * (energy(row.strain) - energy(rows.front().strain));
    out.error = std::max(out.error, std::fabs(row.residual) / most);
  }
  return out;
}

}  // namespace ropewalk::calibrate
