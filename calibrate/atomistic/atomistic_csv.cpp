#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <sstream>

#include "atomistic/stiffness.hpp"
#include "io/files.hpp"
#include "io/plain_text.hpp"

namespace ropewalk {
namespace {

constexpr const char* format_line = "# ropewalk-atomistic-1";
constexpr std::array<OutputColumn, 9> table = {{
    {"kind", "",
     "stretch-twist, bend-short, bend-long; these with wide- before them, up to the limits of the tube; or the "
     "name of an envelope run"},
    {"length_nm", "nm", "length of the relaxed straight cell, or of the bent part"},
    {"strain", "", "strain against the relaxed tube"},
    {"twist_rad_per_nm", "rad/nm", "twist against the rolled sheet"},
    {"curvature_per_nm", "1/nm", "curvature of the axis"},
    {"atoms", "", "atoms of the cell"},
    {"energy_eV", "eV", "energy of the cell above that of the relaxed straight tube"},
    {"residual_eV", "eV", "residual of the fit"},
    {"radius_nm", "nm", "mean distance of the atoms from the axis, in straight cells"},
}};
const std::string columns = column_names(table);

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells(1);
  for (const char character : line) {
    if (character == ',')
      cells.emplace_back();
    else if (character != '\r')
      cells.back() += character;
  }
  return cells;
}

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(" \t\r");
  if (first == std::string::npos) return "";
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

void read_origin_line(const std::string& line, AtomisticOrigin& origin) {
  const auto colon = line.find(':');
  if (colon == std::string::npos) return;
  const std::string key = trimmed(line.substr(1, colon - 1)), value = trimmed(line.substr(colon + 1));
  if (key == "chirality") std::sscanf(value.c_str(), "%d,%d", &origin.chirality.n, &origin.chirality.m);
  if (key == "potential") origin.potential = value;
  if (key == "potential file xxh64") origin.potential_hash = value;
  if (key == "LAMMPS") origin.lammps = value;
  if (key == "note") origin.notes.push_back(value);
}

}  // namespace

std::vector<OutputColumn> atomistic_columns() { return {table.begin(), table.end()}; }

std::string atomistic_csv(const std::vector<AtomisticRow>& rows, const AtomisticOrigin& origin) {
  std::string text = fmt::format("{}\n# chirality: {},{}\n", format_line, origin.chirality.n, origin.chirality.m);
  if (!origin.potential.empty()) text += fmt::format("# potential: {}\n", origin.potential);
  if (!origin.potential_hash.empty()) text += fmt::format("# potential file xxh64: {}\n", origin.potential_hash);
  if (!origin.lammps.empty()) text += fmt::format("# LAMMPS: {}\n", origin.lammps);
  for (const std::string& note : origin.notes) text += fmt::format("# note: {}\n", note);
  text += fmt::format("{}\n", columns);
  // The fit uses small differences of energies: they need twelve digits.
  for (const AtomisticRow& row : rows)
    text += fmt::format("{},{:.12g},{:.12g},{:.12g},{:.12g},{},{:.12g},{:.4g},{:.10g}\n", row.kind, row.length,
                        row.strain, row.twist, row.curvature, row.atoms, row.energy, row.residual, row.radius);
  return text;
}

std::vector<AtomisticRow> read_atomistic_csv(const std::string& path, AtomisticOrigin* origin) {
  AtomisticOrigin ignored;
  AtomisticOrigin& head = origin ? *origin : ignored;
  head = AtomisticOrigin();
  std::istringstream lines(read_file(path));
  std::vector<AtomisticRow> rows;
  bool has_columns = false;
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    if (trimmed(line).empty()) continue;
    if (has_control_character(trimmed(line)))
      throw InputError({path, number, ""}, "holds a control character",
                       "write plain text, with commas between columns");
    if (line[0] == '#') {
      read_origin_line(line, head);
      continue;
    }
    if (!has_columns) {
      if (trimmed(line) != columns)
        throw InputError({path, number, ""}, "the columns of an atomistic table are expected",
                         fmt::format("write {}", columns));
      has_columns = true;
      continue;
    }
    const std::vector<std::string> cells = cells_of(line);
    if (cells.size() != table.size())
      throw InputError({path, number, ""}, fmt::format("has {} columns, not {}", cells.size(), table.size()),
                       fmt::format("they are {}", columns));
    const auto number_in = [&](std::size_t k) {
      const std::string text = trimmed(cells[k]);
      char* end = nullptr;
      const double value = std::strtod(text.c_str(), &end);
      if (text.empty() || *end != '\0' || !std::isfinite(value))
        throw InputError({path, number, table[k].name}, fmt::format("'{}' is not a number", text),
                         "write a finite number");
      return value;
    };
    AtomisticRow row;
    row.kind = trimmed(cells[0]);
    if (row.kind.empty())
      throw InputError({path, number, "kind"}, "is empty", "write stretch-twist, bend-short, ...");
    row.length = number_in(1);
    row.strain = number_in(2);
    row.twist = number_in(3);
    row.curvature = number_in(4);
    const double atoms = number_in(5);
    if (!(atoms >= 1 && atoms <= 1e9 && atoms == std::floor(atoms)))
      throw InputError({path, number, "atoms"}, fmt::format("'{}' is not a count", trimmed(cells[5])),
                       "write a positive whole number");
    row.atoms = static_cast<int>(atoms);
    row.energy = number_in(6);
    row.residual = number_in(7);
    row.radius = number_in(8);
    if (!(row.length > 0))
      throw InputError({path, number, "length_nm"}, "must be positive", "write the length of the relaxed cell");
    rows.push_back(row);
  }
  if (!has_columns) throw InputError({path, 0, ""}, "has no columns", fmt::format("write {}", columns));
  if (rows.empty()) throw InputError({path, 0, ""}, "has no rows", "make it with ropewalk calibrate");
  return rows;
}

}  // namespace ropewalk
