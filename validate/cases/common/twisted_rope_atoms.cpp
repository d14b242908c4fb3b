// The twisted rope of atoms: places of the atoms, LAMMPS input and results.
#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <sstream>

#include "atomistic/lammps.hpp"
#include "atomistic/lattice.hpp"
#include "atomistic/potential.hpp"
#include "atomistic/runs.hpp"
#include "cases/common/twisted_rope.hpp"
#include "io/files.hpp"
#include "scene/build.hpp"

namespace ropewalk {
namespace {

constexpr int tubes = 7;
constexpr double golden = 0.6180339887498949;  // of the additive sequence that spreads the registries

double part(double x) { return x - std::floor(x); }

// Fractions of the symmetries of a tube: five- or tenfold turns and half periods.
double turn_of(int tube, Chirality c) { return part(tube * golden) * 2 * units::pi / c.n; }
double shift_of(int tube, double row) { return (part(tube * golden * golden * golden) - 0.5) * row; }

// The grip's atoms move along the axis together: each feels the mean force.
std::string hold_text(bool axial_free) {
  if (!axial_free) return "fix hold held setforce 0.0 0.0 0.0\n";
  return "fix hold below setforce 0.0 0.0 0.0\n"
         "fix ride above setforce 0.0 0.0 NULL\n"
         "fix together above aveforce NULL NULL 0.0\n";
}

std::string release_text(bool axial_free) {
  return axial_free ? "unfix hold\nunfix ride\nunfix together\n" : "unfix hold\n";
}

// The interior is turned evenly with the grips before it is relaxed. The moment needs the forces on held atoms, so
// that the fixes which hold them are removed while it is read.
std::string increments_text(const TwistedRope& rope, double length, bool axial_free) {
  const double half = 0.5 * rope.step * units::rad_in_degree;
  const std::string minimise = hold_text(axial_free) + "minimize 0.0 5.0e-3 3000 6000\n";
  const std::string report = release_text(axial_free) + "run 0 post no\n" +
                             "print \"$(v_i) $(pe) $(c_lj) $(v_moment/10) $(v_pull) $(v_rise/10)\" append " +
                             (axial_free ? "free.dat" : "fixed.dat") + " screen no\n";
  std::string text = fmt::format(
      "variable i equal 0\n"
      "variable part atom f_ref[3]/{:.12f}\n"
      "variable turned atom v_part*{:.15f}\n"
      "variable dx atom x*(cos(v_turned)-1)-y*sin(v_turned)\n"
      "variable dy atom x*sin(v_turned)+y*(cos(v_turned)-1)\n",
      length / angstrom, rope.step);
  text += minimise + report;
  text += fmt::format(
      "variable count loop {}\n"
      "label next_increment\n"
      "variable i equal ${{count}}\n"
      "displace_atoms free move v_dx v_dy 0.0 units box\n"
      "displace_atoms above rotate 0 0 0 0 0 1 {:.12f} units box\n"
      "displace_atoms below rotate 0 0 0 0 0 1 {:.12f} units box\n",
      rope.increments, half, -half);
  return text + minimise + report + "next count\njump SELF next_increment\n";
}

std::string input_text(const TwistedRope& rope, const ParameterSet& set, const Potential& potential,
                       const std::vector<RopeTube>& atoms, bool axial_free) {
  std::string text = header_commands("s s s", 0.05) + "read_data rope.data\n";
  text += rope_pairs(potential, set.line->universal) + rope_groups(atoms);
  text +=
      "fix ref all store/state 0 x y z\n"
      "compute lj all pair lj/cut\n"
      "variable torque atom x*fy-y*fx\n"
      "compute twisting above reduce sum v_torque\n"
      "variable moment equal -10*c_twisting\n"
      "variable lift atom z-f_ref[3]\n"
      "compute lifts above reduce ave v_lift\n"
      "variable rise equal c_lifts\n"
      "compute pulls above reduce sum fz\n"
      "variable pull equal -10*c_pulls\n"
      "min_style cg\n"
      "min_modify dmax 0.05 line quadratic\n"
      "thermo_style custom step pe fnorm fmax c_lj c_twisting c_lifts c_pulls\n"
      "thermo 100\n"
      "thermo_modify flush yes lost error norm no format float %.12g\n";
  return text + increments_text(rope, clamped_length(rope, set), axial_free);
}

void read_rows(const std::string& path, bool axial_free, const TwistedRope& rope, ReferenceTable& table) {
  std::istringstream lines(read_file(path));
  double i = 0, energy = 0, lj = 0, moment = 0, force = 0, rise = 0;
  int count = 0;
  while (lines >> i >> energy >> lj >> moment >> force >> rise) {
    table.rows.push_back({axial_free ? 1.0 : 0.0, i * rope.step, energy, energy - lj, lj, moment, force, rise});
    ++count;
  }
  if (count != rope.increments + 1)
    throw LammpsError(fmt::format("LAMMPS left {} of {} increments in {}", count, rope.increments + 1, path));
}

}  // namespace

std::string rope_data(const std::vector<RopeTube>& rope) {
  std::size_t count = 0;
  double half = 0;
  std::string atoms;
  int type = 0;
  for (const RopeTube& tube : rope) {
    ++type;
    for (const auto* group : {&tube.below, &tube.free, &tube.above})
      for (const Vector3& atom : *group) {
        half = std::max(half, atom.cwiseAbs().maxCoeff() + 1);
        atoms += fmt::format("{} {} {:.12f} {:.12f} {:.12f}\n", ++count, type, atom.x() / angstrom,
                             atom.y() / angstrom, atom.z() / angstrom);
      }
  }
  std::string text = fmt::format("rope of nanotubes, Angstrom\n\n{} atoms\n{} atom types\n\n", count, tubes);
  for (const char axis : {'x', 'y', 'z'})
    text += fmt::format("{:.6f} {:.6f} {}lo {}hi\n", -half / angstrom, half / angstrom, axis, axis);
  text += "\nMasses\n\n";
  for (int t = 1; t <= tubes; ++t) text += fmt::format("{} {}\n", t, units::carbon_atomic_weight);
  return text + "\nAtoms # atomic\n\n" + atoms;
}

std::string rope_pairs(const Potential& potential, const UniversalLine& law) {
  std::string text = "pair_style hybrid/overlay";
  for (int t = 0; t < tubes; ++t) text += " " + potential.pair_style;
  text += fmt::format(" lj/cut {:.6f}\n", law.lj_cutoff / angstrom);
  for (int t = 1; t <= tubes; ++t) {
    text += fmt::format("pair_coeff * * {} {} {}", potential.pair_style, t, potential.file);
    for (int k = 1; k <= tubes; ++k) text += k == t ? " C" : " NULL";
    text += "\n";
  }
  for (int t = 1; t < tubes; ++t)
    text += fmt::format("pair_coeff {} {}*{} lj/cut {:.8f} {:.6f}\n", t, t + 1, tubes, law.epsilon,
                        law.sigma / angstrom);
  return text;
}

std::string rope_groups(const std::vector<RopeTube>& rope) {
  std::string below = "group below id", above = "group above id";
  std::size_t first = 1;
  for (const RopeTube& tube : rope) {
    below += fmt::format(" {}:{}", first, first + tube.below.size() - 1);
    first += tube.below.size() + tube.free.size();
    above += fmt::format(" {}:{}", first, first + tube.above.size() - 1);
    first += tube.above.size();
  }
  return below + "\n" + above + "\ngroup held union below above\ngroup free subtract all held\n";
}

double row_distance(const ParameterSet& set) {
  // n hexagons of two atoms each in a row of an armchair tube.
  return 2.0 * set.chirality.n / set.atoms_per_length;
}

double clamped_length(const TwistedRope& rope, const ParameterSet& set) {
  return (rope.free_rows + 1) * row_distance(set);
}

std::vector<RopeTube> rope_atoms(const TwistedRope& rope, const ParameterSet& set) {
  const Chirality c = set.chirality;
  const double row = row_distance(set);
  const TubeShape shape{set.radius, row / c.n, 0, 0, 0};
  const long rows = rope.free_rows + 2 * rope.band_rows;
  const std::vector<Site> sites = strip_sites(c, rows * c.n);
  std::vector<RopeTube> out;
  for (const auto& [x, y] : hexagonal_lattice(tubes, set.line->pair_spacing)) {
    const int t = static_cast<int>(out.size());
    const Eigen::AngleAxisd turn(turn_of(t, c), Vector3::UnitZ());
    const double middle = 0.5 * static_cast<double>(rows - 1) * row;
    const Vector3 shift(x, y, shift_of(t, row));
    RopeTube tube;
    for (const Site& site : sites) {
      const long at = height_in_thirds(c, site) / (3 * c.n);
      auto& group = at < rope.band_rows                    ? tube.below
                    : at < rope.band_rows + rope.free_rows ? tube.free
                                                           : tube.above;
      group.push_back(turn * (place(c, site, shape) - Vector3(0, 0, middle)) + shift);
    }
    out.push_back(tube);
  }
  return out;
}

ReferenceTable twist_atoms(const TwistedRope& rope, const CaseContext& context) {
  const ParameterSet set = context.parameters(rope.parameters);
  const Potential potential = find_potential("tersoff");
  const std::vector<RopeTube> atoms = rope_atoms(rope, set);
  LammpsOptions options;
  options.quiet_seconds = 600;

  ReferenceTable table;
  table.columns = {"axial_free", "angle_rad", "energy_eV",   "tersoff_eV",
                   "vdw_eV",     "moment_eV", "force_eV_nm", "rise_nm"};
  std::filesystem::create_directories(context.work);
  const std::string data = rope_data(atoms);
  write_file_atomically(context.work + "/rope.data", data);
  std::string inputs = data;
  const auto start = std::chrono::steady_clock::now();
  for (const bool axial_free : rope.axial_free) {
    const std::string name = axial_free ? "free" : "fixed";
    if (context.progress) context.progress(fmt::format("LAMMPS: grips {} along the axis", name));
    const std::string results = context.work + "/" + name + ".dat";
    std::filesystem::remove(results);
    const std::string input = input_text(rope, set, potential, atoms, axial_free);
    run_lammps(context.work, name, input, options);
    read_rows(results, axial_free, rope, table);
    inputs += input;
  }
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;

  table.add("title", fmt::format("7-tube rope of ({},{}) twisted by rigid grips, clamped length {:.4f} nm",
                                 set.chirality.n, set.chirality.m, clamped_length(rope, set)));
  table.add("potential",
            fmt::format("{} ({}, hash {})", potential.name,
                        std::filesystem::path(potential.file).filename().string(), potential.file_hash));
  const UniversalLine& law = set.line->universal;
  table.add("lennard_jones", fmt::format("epsilon {} eV, sigma {} nm, cutoff {} nm, between tubes only",
                                         law.epsilon, law.sigma, law.lj_cutoff));
  table.add("lammps", lammps_version(options).text);
  table.add("input_hash", hash_hex(inputs));
  table.add("wall_seconds", fmt::format("{:.0f}", seconds.count()));
  table.add("command", fmt::format("ropewalk validate run {} --fresh", rope.name));
  return table;
}

}  // namespace ropewalk
