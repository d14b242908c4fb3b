#include "atomistic/runs.hpp"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <functional>
#include <sstream>

#include "io/clocks.hpp"
#include "io/files.hpp"
#include "io/plain_text.hpp"

namespace ropewalk::calibrate {

PairStyle pair_style_of(const Potential& potential, const std::string& why) {
  const auto refuse = [&](const std::string& line) {
    throw InputError({potential.file, 0, potential.name == "user" ? "--potential-file" : "--potential"},
                     fmt::format("has the line \"{}\", {}", printable(line, 60), why),
                     "take one with pair_style STYLE and pair_coeff * * FILE C");
  };
  const auto words_of = [](const std::string& line) {
    std::vector<std::string> words;
    std::istringstream stream(line);
    for (std::string word; stream >> word;) words.push_back(word);
    return words;
  };
  if (potential.commands.size() != 2) refuse(potential.commands.empty() ? "" : potential.commands.back());
  const std::vector<std::string> style = words_of(potential.commands[0]), coeff = words_of(potential.commands[1]);
  if (style.size() < 2 || style[0] != "pair_style" || style[1].rfind("hybrid", 0) == 0)
    refuse(potential.commands[0]);
  if (coeff.size() != 5 || coeff[0] != "pair_coeff" || coeff[1] != "*" || coeff[2] != "*")
    refuse(potential.commands[1]);
  PairStyle own = {style[1], style[1], coeff[3], coeff[4]};
  for (std::size_t k = 2; k < style.size(); ++k) own.with_arguments += " " + style[k];
  return own;
}

std::string header_commands(const std::string& boundary, double skin) {
  return fmt::format(
      "clear\n"
      "units metal\n"
      "atom_style atomic\n"
      "atom_modify map array sort 0 0.0\n"
      "boundary {}\n"
      "neighbor {:.3f} bin\n"
      "neigh_modify delay 0 every 1 check yes\n",
      boundary, skin / angstrom);
}

namespace {

// `types` of one tube: 1, or 2 for two species.
struct AtomLines {
  const Honeycomb& honeycomb;
  std::size_t types = 0, id = 0;
  std::string masses{}, atoms{};

  void add_tube(const std::vector<Vector3>& tube, const std::function<bool(std::size_t)>& second) {
    const std::size_t first = types + 1;
    for (std::size_t k = 0; k < (honeycomb.one_species() ? 1 : 2); ++k)
      masses += fmt::format("{} {}\n", ++types, honeycomb.atomic_weight[k]);
    for (std::size_t i = 0; i < tube.size(); ++i)
      atoms += fmt::format("{} {} {:.12f} {:.12f} {:.12f}\n", ++id, second(i) ? types : first,
                           tube[i].x() / angstrom, tube[i].y() / angstrom, tube[i].z() / angstrom);
  }
  std::string text(double half_width, double z_low, double z_high) const;
};

}  // namespace

std::string data_file(const std::vector<std::vector<Vector3>>& tubes, double half_width, double z_low, double z_high,
                      const Honeycomb& honeycomb) {
  AtomLines lines{honeycomb};
  for (const std::vector<Vector3>& tube : tubes)
    lines.add_tube(tube, [&](std::size_t i) { return i >= tube.size() / 2; });
  return lines.text(half_width, z_low, z_high);
}

std::string data_file_of_tube(const std::vector<Vector3>& atoms, const std::vector<char>& second, double half_width,
                              double z_low, double z_high, const Honeycomb& honeycomb) {
  AtomLines lines{honeycomb};
  lines.add_tube(atoms, [&](std::size_t i) { return second[i] != 0; });
  return lines.text(half_width, z_low, z_high);
}

std::string AtomLines::text(double half_width, double z_low, double z_high) const {
  const double half = half_width / angstrom;
  return fmt::format(
      "{} nanotubes, Angstrom\n\n{} atoms\n{} atom types\n\n{:.6f} {:.6f} xlo xhi\n{:.6f} {:.6f} ylo yhi\n"
      "{:.12f} {:.12f} zlo zhi\n\nMasses\n\n{}\nAtoms # atomic\n\n{}",
      honeycomb.carbon() ? "carbon" : honeycomb.name, id, types, -half, half, -half, half, z_low / angstrom, z_high / angstrom, masses, atoms);
}

std::string cell_commands(const Potential& potential, const std::string& data) {
  std::string text = header_commands("s s p", 0.05) + "read_data " + data + "\n";
  for (const std::string& command : potential.commands) text += command + "\n";
  return text +
         "min_style cg\nmin_modify dmax 0.05 line quadratic\nthermo 200\n"
         "thermo_modify flush yes lost error norm no\n";
}

void write_data(const RunContext& run, const std::string& name, const std::string& content) {
  std::error_code code;
  std::filesystem::create_directories(run.folder, code);  // write_file_atomically() reports an error
  write_file_atomically(run.folder + "/" + name, content);
}

void run_stage(RunContext& run, const std::string& name, const std::string& input) {
  const double start = steady_seconds();
  run_lammps(run.folder, name, input, run.options.lammps);
  run.lammps_seconds += seconds_since(start);
}

std::vector<std::vector<double>> read_results(const std::string& folder, const std::string& name, std::size_t least,
                                              std::size_t most, std::size_t columns) {
  const std::string path = folder + "/" + name + ".dat";
  const auto fail = [&](const std::string& what) {
    refuse_full_disk(folder);
    throw LammpsError(
        fmt::format("LAMMPS ({}/{}.in) {}; its input and log are in that folder, and the disk may be full", folder,
                    name, what));
  };
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) fail("left no results");
  std::vector<std::vector<double>> table;
  std::istringstream lines(read_file(path));
  for (std::string line; std::getline(lines, line);) {
    std::vector<double> row;
    std::istringstream words(line);
    for (std::string word; words >> word;) {
      char* end = nullptr;
      row.push_back(std::strtod(word.c_str(), &end));
      if (*end != '\0' || !std::isfinite(row.back())) fail(fmt::format("gave '{}' for a number", word));
    }
    if (row.size() != columns) fail(fmt::format("left an incomplete line {} in {}.dat", table.size() + 1, name));
    table.push_back(row);
  }
  if (table.size() < least || table.size() > most) fail(fmt::format("left {} of {} results", table.size(), most));
  return table;
}

std::vector<Vector3> read_atoms(const RunContext& run, const std::string& name, std::size_t count) {
  const std::string path = run.folder + "/" + name;
  if (!std::filesystem::exists(path)) refuse_full_disk(run.folder);
  std::istringstream lines(read_file(path));
  std::vector<Vector3> atoms;
  std::string line;
  while (std::getline(lines, line) && line.rfind("ITEM: ATOMS", 0) != 0) {
  }
  while (std::getline(lines, line)) {
    std::istringstream words(line);
    long id = 0;
    double x = 0, y = 0, z = 0;
    if (words >> id >> x >> y >> z) atoms.push_back(Vector3(x, y, z) * angstrom);
  }
  if (atoms.size() == count) return atoms;
  refuse_full_disk(run.folder);
  throw LammpsError(
      fmt::format("LAMMPS left {} of {} atoms in {}; the disk may be full", atoms.size(), count, path));
}

void check_convergence(RunContext& run, const std::string& what, double force, double energy) {
  // A residual force f leaves an energy f^2/2K in a mode of stiffness K. Only the bending of a long tube is softer
  // than 100 eV/nm^2.
  const double left = 0.5 * force * force / 100;
  if (left > 1e-3 * energy)
    run.warnings.push_back(
        fmt::format("{} is not well converged: forces of {:.2g} eV/nm are left, worth up to {:.2g} of {:.2g} eV",
                    what, force, left, energy));
}

}  // namespace ropewalk::calibrate
