// `ropewalk calibrate check-shipped`: makes a shipped set again and compares it with the file.
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <string>
#include <tuple>
#include <vector>

#include "atoms/honeycomb_file.hpp"
#include "io/data_files.hpp"
#include "io/parameters_toml.hpp"
#include "verbs/verbs.hpp"

namespace ropewalk::calibrate {
namespace {

struct CheckShippedArguments {
  std::string set = "cnt-5-5-tersoff";
  bool all = false;
  double tolerance = 0.002;  // relative
};

namespace fs = std::filesystem;

double value_of(const ParameterSet& set, const std::string& key) {
  const Quantity* q = find_quantity(set, key);
  if (!q)
    throw InputError({set.path, 0, key}, "is missing", "only a set made by `ropewalk calibrate` can be remade");
  return q->value;
}

Calibration remake(const ParameterSet& set) {
  CalibrationRequest request = request_of(set);
  request.stiffness.lammps.interrupted = [] { return interrupted_by() != 0; };
  WorkFolder folder("");
  request.folder = folder.path();
  try {
    return calibrate(request);
  } catch (const LammpsError& e) {
    folder.stay_for(e);
    throw;
  }
}

}  // namespace

CalibrationRequest request_of(const ParameterSet& set) {
  CalibrationRequest request;
  request.chirality = set.chirality;
  for (const Wall& wall : set.walls) request.walls.push_back(wall.chirality);
  request.outer_carries = set.outer_carries;
  if (!set.walls.empty())
    std::tie(request.stiffness.short_length, request.stiffness.long_length) = specimen_lengths(request.walls);
  const std::string potential = provenance_value(set, "potential");
  if (potential.empty())
    throw InputError({set.path, 0, "provenance.potential"}, "is missing",
                     "only a set made by `ropewalk calibrate` can be remade");
  request.potential = potential_of(set, potential);
  request.law = parse_atom_law(
      fmt::format("{},{}", value_of(set, "contact.line.epsilon"), value_of(set, "contact.line.sigma")),
      value_of(set, "contact.line.lj_cutoff"));
  return request;
}

// K, s, c, p and q are not among them, since they are strongly correlated.
std::vector<std::string> compared_numbers(const ParameterSet& set) {
  std::vector<std::string> keys = {set.walls.empty() ? "tube.radius" : "tube.contact_radius", "tube.atoms_per_length"};
  for (std::size_t k = 1; k <= set.walls.size(); ++k)
    for (const char* number : {"radius", "atoms_per_length", "EA", "EI", "GJ"})
      keys.push_back(fmt::format("wall.{}.{}", k, number));
  for (const char* number : {"EA", "EI", "GJ", "kGA"}) keys.push_back(fmt::format("bond.{}", number));
  for (const char* way : {"all", "outer"})
    for (const char* number : {"EA", "EI", "GJ"})
      if (!set.walls.empty()) keys.push_back(fmt::format("held.{}.{}", way, number));
  for (const char* number : {"surface_density", "pair_spacing", "pair_energy", "cross90_energy", "registry"})
    keys.push_back(fmt::format("contact.line.{}", number));
  return keys;
}

namespace {

bool check_one(const std::string& name, double tolerance) {
  const ParameterSet shipped = read_parameters(find_parameters(name, "", {"", 0, "set"}));
  const Calibration c = remake(shipped);
  const ParameterSet remade = parameter_set(c, "", "");
  fmt::print("{}, made anew in {:.1f} s\n", shipped.name, c.seconds);
  bool same = true;
  for (const std::string& key : compared_numbers(shipped)) {
    const double a = value_of(shipped, key), b = value_of(remade, key);
    const double difference = (b - a) / std::fabs(a);
    const bool near = std::fabs(difference) <= tolerance;
    same = same && near;
    fmt::print("  {:<30} {:>14.8g} {:>14.8g} {:<8} {:+9.1e}{}\n", key, a, b, find_quantity(shipped, key)->unit,
               difference, near ? "" : "  DIFFERS");
  }
  return same;
}

int check_shipped_command(const CheckShippedArguments& a) {
  std::vector<std::string> names = {a.set};
  if (a.all) {
    names.clear();
    for (const auto& entry : fs::directory_iterator(data_directory() + "/parameters"))
      if (entry.path().extension() == ".toml" && !read_parameters(entry.path().string()).provenance.empty())
        names.push_back(entry.path().stem().string());
    std::sort(names.begin(), names.end());
  }
  bool same = true;
  for (const std::string& name : names) same = check_one(name, a.tolerance) && same;
  fmt::print("{}\n", same ? fmt::format("agree within {:.2g} %", 100 * a.tolerance)
                          : fmt::format("differ by more than {:.2g} %: another LAMMPS or potential file?",
                                        100 * a.tolerance));
  return same ? 0 : 3;
}

}  // namespace

void add_check_shipped(CLI::App& app, Program& program) {
  const auto a = std::make_shared<CheckShippedArguments>();
  CLI::App* c = app.add_subcommand("check-shipped", "Make a shipped set anew and compare");
  c->add_option("set", a->set, "Which")->capture_default_str();
  c->add_flag("--all", a->all, "All of them");
  c->add_option("--tolerance", a->tolerance, "Relative difference allowed")
      ->capture_default_str()
      ->check(number_within(Bounds::positive()));
  c->callback([a, &program] { program.code = check_shipped_command(*a); });
}

}  // namespace ropewalk::calibrate
