#include "atoms/honeycomb_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "io/data_files.hpp"
#include "io/files.hpp"
#include "io/parameters_toml.hpp"
#include "io/toml_table.hpp"

namespace ropewalk {
namespace {

namespace fs = std::filesystem;

std::string shipped_folder() { return data_directory() + "/atoms"; }

std::string find_atoms(const std::string& name) {
  std::error_code error;
  if (fs::is_regular_file(name, error)) return name;
  const fs::path shipped = fs::path(shipped_folder()) / (name + ".toml");
  if (name.find('/') == std::string::npos && fs::is_regular_file(shipped, error)) return shipped.string();
  std::vector<std::string> names = {"C"};
  for (const auto& entry : fs::directory_iterator(shipped_folder(), error))
    if (entry.path().extension() == ".toml") names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  throw InputError(
      {"", 0, "--atoms"}, fmt::format("is \"{}\"", printable(name, 60)),
      fmt::format("name one of {}, or a file that says what the atoms are (docs/how-to/boron-nitride.md)",
                  fmt::join(names, ", ")));
}

std::array<double, 2> two_numbers(const TomlTable& t, const char* key, const Bounds& bounds) {
  const std::vector<double> both = t.numbers(key, bounds, 2);
  return {both[0], both[1]};
}

std::array<std::string, 2> two_elements(const TomlTable& t, const char* key) {
  const std::vector<std::string> both = t.strings(key);
  if (both.size() != 2)
    throw t.error(key, fmt::format("has {} name{}", both.size(), both.size() == 1 ? "" : "s"),
                  "name two, of the first and of the second sublattice: [\"B\", \"N\"]");
  for (const std::string& symbol : both) check_element(t, key, symbol);
  return {both[0], both[1]};
}

void check_doi(const TomlTable& t, const std::string& doi) {
  if (doi.empty() || (doi.compare(0, 3, "10.") == 0 && doi.find('/') != std::string::npos)) return;
  throw t.error("doi", fmt::format("is \"{}\"", printable(doi, 40)), "write it bare, as in 10.1000/182");
}

void read_contact(const TomlTable& top, Potential& out) {
  if (!top.has("lennard_jones"))
    throw top.error("lennard_jones", "is missing: how atoms of two tubes attract",
                    "add [lennard_jones] epsilon_eV, sigma_nm and reference");
  const TomlTable t = top.table("lennard_jones");
  const std::array<double, 2> epsilon = two_numbers(t, "epsilon_eV", Bounds::positive(1)),
                              sigma = two_numbers(t, "sigma_nm", Bounds::range(0.2, 0.6));
  std::array<PairLaw, 3>& pairs = out.honeycomb.pairs;
  pairs[0] = {epsilon[0], sigma[0]};
  pairs[2] = {epsilon[1], sigma[1]};
  pairs[1] = mixed_law(pairs[0], pairs[2]);
  pairs[1].epsilon = t.number_or("epsilon_12_eV", pairs[1].epsilon, Bounds::positive(1));
  pairs[1].sigma = t.number_or("sigma_12_nm", pairs[1].sigma, Bounds::range(0.2, 0.6));
  out.pairs_reference = t.string("reference");
  out.pairs_doi = t.string_or("doi", "");
  check_doi(t, out.pairs_doi);
}

PotentialLines read_lines(const TomlTable& t, const std::string& folder) {
  PotentialLines lines;
  lines.name = t.string("name");
  if (!std::all_of(lines.name.begin(), lines.name.end(), [](unsigned char c) { return std::isalnum(c) != 0; }))
    throw t.error("name", fmt::format("is \"{}\"", printable(lines.name, 40)),
                  "write letters and digits: sets are named by it");
  lines.style = t.string("pair_style");
  lines.file = t.string("file");
  lines.folder = folder;
  for (const char* key : {"pair_style", "file"}) refuse_reach(t.error(key, "", "").place(), t.string(key));
  const std::array<std::string, 2> elements = two_elements(t, "elements");
  lines.elements = {elements[0], elements[1]};  // one type where both species are the same
  lines.cutoff = t.number("cutoff_nm", Bounds::range(0.1, 2));
  lines.inner = t.number("bond_cutoff_nm", Bounds::range(0.1, lines.cutoff));
  lines.reference = t.string("reference");
  lines.doi = t.string_or("doi", "");
  check_doi(t, lines.doi);
  return lines;
}

}  // namespace

Potential potential_of_atoms(const std::string& atoms, const std::string& name) {
  if (atoms.empty() || atoms == "C") return find_potential(name.empty() ? "tersoff" : name);
  const std::string path = find_atoms(atoms);
  const TomlTable top = TomlTable::parse(read_file(path), path);
  if (top.string("format") != atoms_format)
    throw top.error("format", fmt::format("is \"{}\"", printable(top.string("format"), 40)),
                    fmt::format("this program reads \"{}\"", atoms_format));
  Potential out;
  Honeycomb& h = out.honeycomb;
  h.name = top.string("name");
  check_name_of_honeycomb(top, "name", h.name);
  h.species = two_elements(top, "species");
  h.atomic_weight = two_numbers(top, "weight_u", Bounds::range(1, 300));
  h.lattice_constant = std::sqrt(3.0) * top.number("bond_length_nm", Bounds::range(0.1, 0.4));
  read_contact(top, out);
  std::vector<PotentialLines> all;
  for (const TomlTable& t : top.tables("potential"))
    all.push_back(read_lines(t, fs::path(path).parent_path().string()));
  if (all.empty())
    throw top.error("potential", "is missing", "add [[potential]] with name, pair_style, file and elements");
  top.finish();
  const auto at =
      name.empty() ? all.begin()
                   : std::find_if(all.begin(), all.end(), [&](const PotentialLines& p) { return p.name == name; });
  if (at == all.end()) {
    std::vector<std::string> names;
    for (const PotentialLines& p : all) names.push_back(p.name);
    throw InputError({path, 0, "potential"}, fmt::format("'{}' is none of {}", printable(name, 40), h.name),
                     fmt::format("choose {}", fmt::join(names, " or ")));
  }
  if (h.one_species()) at->elements.resize(1);
  const Honeycomb honeycomb = h;
  const std::string reference = out.pairs_reference, doi = out.pairs_doi;
  out = potential_of_lines(*at);
  out.honeycomb = honeycomb;
  out.pairs_reference = reference;
  out.pairs_doi = doi;
  out.atoms = atoms;
  return out;
}

Potential potential_of(const ParameterSet& set, const std::string& name) {
  if (set.honeycomb.carbon()) return find_potential(name);
  const std::string atoms = provenance_value(set, "atoms");
  if (atoms.empty())
    throw InputError({set.path, 0, "provenance.atoms"},
                     fmt::format("is missing, which names the file of {}", set.honeycomb.name),
                     "make the set anew: ropewalk calibrate --atoms");
  return potential_of_atoms(atoms, name);
}

}  // namespace ropewalk
