#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdio>

#include "atomistic/stiffness.hpp"
#include "io/csv_reader.hpp"
#include "io/plain_text.hpp"

namespace ropewalk::calibrate {
namespace {

constexpr const char* format_line = "# ropewalk-atomistic-1";
constexpr std::array<OutputColumn, 9> table = {{
    {"kind", "",
     "stretch-twist, bend-short, bend-long; these with wide- before them, up to the limits of the tube; pull; or "
     "the name of an envelope run"},
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

// "key: value".
void read_origin(std::string_view comment, AtomisticOrigin& origin) {
  const auto colon = comment.find(':');
  if (colon == std::string_view::npos) return;
  const std::string_view key = comment.substr(0, colon);
  const std::size_t from = comment.find_first_not_of(" \t", colon + 1);
  const std::string value(from == std::string_view::npos ? "" : comment.substr(from));
  if (key == "chirality") std::sscanf(value.c_str(), "%d,%d", &origin.chirality.n, &origin.chirality.m);
  if (key == "species") origin.species = value;
  if (key == "potential") origin.potential = value;
  if (key == "potential file xxh64") origin.potential_hash = value;
  if (key == "LAMMPS") origin.lammps = value;
  if (key == "note") origin.notes.push_back(value);
}

AtomisticRow row_of(const CsvReader& csv) {
  if (csv.cells().size() != table.size())
    csv.fail("", fmt::format("has {} columns, not {}", csv.cells().size(), table.size()),
             fmt::format("they are {}", columns));
  const auto number = [&](std::size_t k) { return csv.finite_number(k, table[k].name, "write a finite number"); };
  AtomisticRow row;
  row.line = csv.line_number();
  row.kind = csv.cells()[0];
  if (row.kind.empty()) csv.fail("kind", "is empty", "write stretch-twist, bend-short, ...");
  row.length = number(1);
  row.strain = number(2);
  row.twist = number(3);
  row.curvature = number(4);
  const double atoms = number(5);
  if (!(atoms >= 1 && atoms <= 1e9 && atoms == std::floor(atoms)))
    csv.fail("atoms", fmt::format("'{}' is not a count", csv.cells()[5]), "write a positive whole number");
  row.atoms = static_cast<int>(atoms);
  row.energy = number(6);
  row.residual = number(7);
  row.radius = number(8);
  if (!(row.length > 0)) csv.fail("length_nm", "must be positive", "write the length of the relaxed cell");
  return row;
}

}  // namespace

std::vector<OutputColumn> atomistic_columns() { return {table.begin(), table.end()}; }

std::string atomistic_csv(const std::vector<AtomisticRow>& rows, const AtomisticOrigin& origin) {
  std::string text = fmt::format("{}\n# chirality: {},{}\n", format_line, origin.chirality.n, origin.chirality.m);
  if (!origin.species.empty()) text += fmt::format("# species: {}\n", origin.species);
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
  CsvReader csv(path);
  if (!csv.next()) throw InputError({path, 0, ""}, "has no columns", fmt::format("write {}", columns));
  std::vector<AtomisticRow> rows;
  const auto read_comments = [&] {
    for (const std::string_view comment : csv.comments()) {
      if (has_control_character(comment))
        csv.fail("", "a comment above holds a control character", "write plain text");
      read_origin(comment, head);
    }
  };
  read_comments();
  if (csv.line_text() != columns)
    csv.fail("", "the columns of an atomistic table are expected", fmt::format("write {}", columns));
  while (csv.next()) {
    read_comments();
    rows.push_back(row_of(csv));
  }
  read_comments();
  if (rows.empty()) throw InputError({path, 0, ""}, "has no rows", "make it with ropewalk calibrate");
  return rows;
}

}  // namespace ropewalk::calibrate
