#include "core/reference.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <stdexcept>

#include "io/csv_reader.hpp"
#include "io/files.hpp"
#include "io/parameters_toml.hpp"
#include "model/contact/line_parameters.hpp"
#include "model/error.hpp"

namespace ropewalk::validate {
namespace {

namespace fs = std::filesystem;

constexpr const char* fresh_remedy = "make the reference again with --fresh";

// "key: value".
void read_origin(std::string_view comment, ReferenceTable& t) {
  const std::size_t colon = comment.find(':');
  if (colon == std::string_view::npos || colon == 0) return;
  const std::size_t from = comment.find_first_not_of(' ', colon + 1);
  t.add(std::string(comment.substr(0, colon)),
        std::string(from == std::string_view::npos ? "" : comment.substr(from)));
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
  CsvReader csv(path);
  while (csv.next()) {
    for (const std::string_view comment : csv.comments()) read_origin(comment, t);
    if (t.columns.empty()) {
      t.columns.assign(csv.cells().begin(), csv.cells().end());
      continue;
    }
    if (csv.cells().size() != t.columns.size())
      csv.fail("", fmt::format("has {} columns, the header {}", csv.cells().size(), t.columns.size()),
               fresh_remedy);
    std::vector<double> row;
    for (std::size_t k = 0; k < t.columns.size(); ++k) row.push_back(csv.number(k, t.columns[k], fresh_remedy));
    t.rows.push_back(std::move(row));
  }
  if (t.rows.empty()) throw InputError({path, 0, ""}, "holds no data", fresh_remedy);
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

std::string leaf_of_name(const ParameterSet& set) { return fs::path(set.name).filename().string(); }

std::string atoms_folder(const ParameterSet& set) {
  return (fs::path(set.path).parent_path() / (leaf_of_name(set) + "-atoms")).string();
}

std::string find_reference(const CaseContext& context, const ParameterSet& set, const std::string& name) {
  const std::string like =
      set.walls.empty() ? fmt::format("{}-{}-{}-{}", set.honeycomb.stem(), set.chirality.n, set.chirality.m,
                                      provenance_value(set, "potential"))
                        : leaf_of_name(set);
  for (const fs::path& folder : {fs::path(atoms_folder(set)), fs::path(context.references) / like})
    if (fs::exists(folder / (name + ".csv"))) return (folder / (name + ".csv")).string();
  return "";
}

std::string between_tubes(const ParameterSet& set) {
  const UniversalLine& law = set.law<LineParameters>()->universal;
  return fmt::format("Lennard-Jones, {} eV, {} nm, cut at {} nm, not shifted", law.epsilon, law.sigma,
                     law.lj_cutoff);
}

void check_origin(const ReferenceTable& table, const std::string& path, const ParameterSet& set) {
  const std::string hash = provenance_value(set, "potential_hash"), law = table.value("between_tubes");
  if (table.value("potential").find("hash " + hash) == std::string::npos)
    throw NotApplicable(
        fmt::format("{} was made with another interatomic potential, {}", path, table.value("potential")));
  if (!law.empty() && (!set.law<LineParameters>() || law != between_tubes(set)))
    throw NotApplicable(fmt::format("in {} tubes attract by another law: {}", path, law));
}

ReferenceTable reference(const CaseContext& context, const ParameterSet& set, const std::string& name,
                         double tolerance, const std::function<ReferenceTable()>& make, CaseResult& result) {
  if (provenance_value(set, "potential_hash").empty())
    throw NotApplicable("the set names no interatomic potential, so that there are no atoms to compare it with");
  if (!provenance_value(set, "fit_command").empty())
    throw NotApplicable("the set was fitted to data of yours, whose atoms are not known");
  const std::string stored = find_reference(context, set, name),
                    label = fmt::format("{}/{}.csv", leaf_of_name(set), name);
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
    fs::create_directories(fs::path(context.work) / leaf_of_name(set));
    write_file_atomically((fs::path(context.work) / label).string(), reference_csv(table));
  } else {
    const std::string path = (fs::path(atoms_folder(set)) / (name + ".csv")).string();
    fs::create_directories(atoms_folder(set));
    write_file_atomically(path, reference_csv(table));
    table = read_reference(path);  // the digits that a later command finds
  }
  result.sources.push_back(fmt::format("{} (fresh, {} s of LAMMPS)", label, table.value("wall_seconds")));
  return table;
}

}  // namespace ropewalk::validate
