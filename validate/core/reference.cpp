#include "core/reference.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <sstream>
#include <stdexcept>

#include "io/files.hpp"
#include "io/parameters_toml.hpp"
#include "io/toml_table.hpp"
#include "model/error.hpp"

namespace ropewalk {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  std::stringstream stream(line);
  for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
  return cells;
}

// "# key: value".
void read_origin(const std::string& line, ReferenceTable& t) {
  const std::size_t colon = line.find(':');
  if (colon == std::string::npos || colon < 3) return;
  const std::size_t from = line.find_first_not_of(' ', colon + 1);
  t.add(line.substr(2, colon - 2), from == std::string::npos ? "" : line.substr(from));
}

std::vector<double> numbers_of(const std::vector<std::string>& cells, const std::string& path, int line) {
  std::vector<double> row;
  for (const std::string& c : cells) {
    double value = 0;
    const auto [end, error] = std::from_chars(c.data(), c.data() + c.size(), value);
    if (error != std::errc() || end != c.data() + c.size())
      throw InputError({path, line, ""}, fmt::format("\"{}\" is not a number", printable(c, 40)),
                       "make the reference again with --fresh");
    row.push_back(value);
  }
  return row;
}

double range_of(const std::vector<double>& values) {
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  return values.empty() ? 0 : *most - *least;
}

// The stored table against the fresh one, column by column.
void compare(const ReferenceTable& stored, const ReferenceTable& fresh, const std::string& name, double tolerance,
             CaseResult& result) {
  if (stored.columns != fresh.columns || stored.rows.size() != fresh.rows.size()) {
    result.remarks.push_back(
        fmt::format("The stored reference {} does not have the rows and columns of the fresh one.", name));
    return;
  }
  for (const std::string& column : fresh.columns) {
    const std::vector<double> a = stored.column(column), b = fresh.column(column);
    const double range = range_of(b);
    double worst = 0;
    for (std::size_t k = 0; k < a.size(); ++k) worst = std::max(worst, std::fabs(a[k] - b[k]));
    Check c;
    c.name = fmt::format("{}: {} stored against fresh", name, column);
    c.value = range > 0 ? worst / range : worst;
    c.tolerance = tolerance;
    c.relative = false;
    c.unit = "of its range";
    result.checks.push_back(c);
  }
}

}  // namespace

std::string ReferenceTable::value(const std::string& key) const {
  for (const auto& [k, v] : origin)
    if (k == key) return v;
  return "";
}

std::vector<double> ReferenceTable::column(const std::string& name) const {
  const auto at = std::find(columns.begin(), columns.end(), name);
  if (at == columns.end()) throw std::out_of_range("the reference has no column " + name);
  const auto k = static_cast<std::size_t>(at - columns.begin());
  std::vector<double> values;
  for (const std::vector<double>& row : rows) values.push_back(row[k]);
  return values;
}

ReferenceTable read_reference(const std::string& path) {
  ReferenceTable t;
  std::istringstream text(read_file(path));
  int number = 0;
  for (std::string line; std::getline(text, line);) {
    ++number;
    if (line.empty()) continue;
    if (line[0] == '#') {
      read_origin(line, t);
    } else if (t.columns.empty()) {
      t.columns = cells_of(line);
    } else {
      t.rows.push_back(numbers_of(cells_of(line), path, number));
      if (t.rows.back().size() != t.columns.size())
        throw InputError({path, number, ""},
                         fmt::format("has {} columns, the header {}", t.rows.back().size(), t.columns.size()),
                         "make the reference again with --fresh");
    }
  }
  if (t.rows.empty()) throw InputError({path, 0, ""}, "holds no data", "make the reference again with --fresh");
  return t;
}

std::string reference_csv(const ReferenceTable& table) {
  std::string text;
  for (const auto& [key, value] : table.origin) text += fmt::format("# {}: {}\n", key, value);
  for (std::size_t k = 0; k < table.columns.size(); ++k) text += (k > 0 ? "," : "") + table.columns[k];
  text += '\n';
  for (const std::vector<double>& row : table.rows) {
    for (std::size_t k = 0; k < row.size(); ++k) text += fmt::format("{}{:.10g}", k > 0 ? "," : "", row[k]);
    text += '\n';
  }
  return text;
}

std::string atoms_folder(const ParameterSet& set) {
  return (fs::path(set.path).parent_path() / (set.name + "-atoms")).string();
}

std::string find_reference(const CaseContext& context, const ParameterSet& set, const std::string& name) {
  const std::string like =
      fmt::format("cnt-{}-{}-{}", set.chirality.n, set.chirality.m, provenance_value(set, "potential"));
  for (const fs::path& folder : {fs::path(atoms_folder(set)), fs::path(context.references) / like})
    if (fs::exists(folder / (name + ".csv"))) return (folder / (name + ".csv")).string();
  return "";
}

std::string between_tubes(const ParameterSet& set) {
  const UniversalLine& law = set.line.value().universal;
  return fmt::format("Lennard-Jones, {} eV, {} nm, cut at {} nm, not shifted", law.epsilon, law.sigma,
                     law.lj_cutoff);
}

void check_origin(const ReferenceTable& table, const std::string& path, const ParameterSet& set) {
  const std::string hash = provenance_value(set, "potential_hash"), law = table.value("between_tubes");
  if (table.value("potential").find("hash " + hash) == std::string::npos)
    throw NotApplicable(
        fmt::format("{} was made with another interatomic potential, {}", path, table.value("potential")));
  if (!law.empty() && (!set.line || law != between_tubes(set)))
    throw NotApplicable(fmt::format("in {} tubes attract by another law: {}", path, law));
}

ReferenceTable reference(const CaseContext& context, const ParameterSet& set, const std::string& name,
                         double tolerance, const std::function<ReferenceTable()>& make, CaseResult& result) {
  if (provenance_value(set, "potential_hash").empty())
    throw NotApplicable("the set names no interatomic potential, so that there are no atoms to compare it with");
  if (!provenance_value(set, "fit_command").empty())
    throw NotApplicable("the set was fitted to data of yours, whose atoms are not known");
  const std::string stored = find_reference(context, set, name), label = fmt::format("{}/{}.csv", set.name, name);
  if (!context.fresh && !stored.empty()) {
    try {
      ReferenceTable table = read_reference(stored);
      check_origin(table, stored, set);
      result.sources.push_back(
          fmt::format("{} (stored; {}, LAMMPS {})", label, table.value("potential"), table.value("lammps")));
      return table;
    } catch (const NotApplicable&) {
      if (!context.make_atoms) throw;
    }
  }
  if (!context.fresh && !context.make_atoms)
    throw NotApplicable(
        fmt::format("there are no atoms of {} to compare with; {}", tube_name(set), context.no_atoms));
  ReferenceTable table = make();
  if (context.fresh) {
    if (!stored.empty()) compare(read_reference(stored), table, label, tolerance, result);
    fs::create_directories(fs::path(context.work) / set.name);
    write_file_atomically((fs::path(context.work) / label).string(), reference_csv(table));
  } else {
    fs::create_directories(atoms_folder(set));
    write_file_atomically((fs::path(atoms_folder(set)) / (name + ".csv")).string(), reference_csv(table));
  }
  result.sources.push_back(fmt::format("{} (fresh, {} s of LAMMPS)", label, table.value("wall_seconds")));
  return table;
}

}  // namespace ropewalk
