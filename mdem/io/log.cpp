#include "io/log.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <filesystem>
#include <iterator>
#include <string_view>

#include "io/csv_reader.hpp"
#include "io/manifest.hpp"
#include "io/toml_table.hpp"
#include "model/error.hpp"

namespace ropewalk {
namespace {

constexpr const char* damaged_log = "the file was changed or damaged; restore it, or run the scene again";

// Columns that logs of 0.3.0 lack, whose runs had nothing of them: they read as 0.
bool is_later(const std::string& column) { return column == "own_forces_eV"; }

// `columns`: the observables that the file has, in its order.
LogRow row_of(const CsvReader& csv, const std::vector<std::size_t>& columns) {
  LogRow row;
  if (csv.cells().size() != columns.size())
    csv.fail("", fmt::format("{} columns, {} are needed", csv.cells().size(), columns.size()), damaged_log);
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const Observable& column = observables()[columns[k]];
    const double v = csv.number(k, column.name, damaged_log);
    if (column.whole && std::isfinite(v) && v != std::floor(v))
      csv.fail(column.name, fmt::format("{} is not an integer", v), damaged_log);
    row.values()[columns[k]] = v;
  }
  return row;
}

// The remedy for a log with other columns: the version of ropewalk that the manifest beside the log names.
std::string other_log(const std::string& path) {
  std::string of = "the version in its manifest.json";
  try {
    const std::filesystem::path manifest = std::filesystem::path(path).parent_path() / "manifest.json";
    if (std::filesystem::exists(manifest))
      of = "ropewalk " + printable(read_manifest(manifest.string()).version, 40) + ", which its manifest.json names";
  } catch (const std::exception&) {  // a damaged one says nothing
  }
  return "is this the log.csv of a run by this version of ropewalk? If not, use " + of + ", or run the scene again";
}

// The observables of its columns.
std::vector<std::size_t> read_header(CsvReader& csv, const std::string& path) {
  if (!csv.next()) throw InputError({path, 1, ""}, "there is no header", other_log(path));
  const std::vector<std::string_view>& names = csv.cells();
  std::vector<std::size_t> columns;
  std::size_t next = 0;
  for (std::size_t k = 0; k < names.size(); ++k, ++next) {
    while (next < observables().size() && names[k] != observables()[next].name && is_later(observables()[next].name))
      ++next;
    const std::string name = printable(std::string(names[k]), 40);
    if (next == observables().size())
      csv.fail("", fmt::format("the header has more than {} columns: \"{}\" is not known", k, name), other_log(path));
    if (names[k] != observables()[next].name)
      csv.fail("",
               fmt::format("column {} of the header is \"{}\", \"{}\" is needed", k + 1, name,
                           observables()[next].name),
               other_log(path));
    columns.push_back(next);
  }
  while (next < observables().size() && is_later(observables()[next].name)) ++next;
  if (next < observables().size())
    csv.fail("",
             fmt::format("the header ends after column {}, \"{}\" is needed next", names.size(),
                         observables()[next].name),
             other_log(path));
  return columns;
}

}  // namespace

LogRow::LogRow(const Measurement& measurement) {
  for (const Observable& observable : observables()) values_.push_back(observable.value(measurement));
}

RopeShape shape_of(const LogRow& row, const LogRow& first) {
  return rope_shape({row["middle_amplitude_nm"], row["writhe"], row["turned_back"], row["radius_mid_nm"],
                     row["radius_end_nm"], row["void_area_nm2"]},
                    first["radius_mid_nm"]);
}

double potential_energy(const LogRow& row) {
  double sum = row["stretch_eV"] + row["shear_eV"] + row["bend_eV"] + row["twist_eV"] + row["vdw_eV"];
  for (const std::string& column : term_energy_columns()) sum += row[column];
  return sum;
}

std::string damping_words(const LogRow& row) {
  const double lost = row["dissipated_eV"], damping = row["damping_eV"];
  if (!(lost > 0.01 * std::fabs(row["work_eV"])) || !(damping > 0.1 * lost)) return "";
  return fmt::format(
      "Numerical damping, which atoms do not have, took {:.3g} % of the {:.3g} eV that were lost. Final "
      "equilibrium "
      "states are meaningful; the path, the speed and the choice among several equilibria depend on the damping.",
      100 * damping / lost, lost);
}

const LogRow* strongest_row(const std::vector<LogRow>& log) {
  const LogRow* most = nullptr;
  for (const LogRow& row : log)
    if (row["stress_GPa"] > (most ? (*most)["stress_GPa"] : 0)) most = &row;
  return most;
}

std::string log_header() {
  std::string text;
  for (const Observable& column : observables()) text += (text.empty() ? "" : ",") + column.name;
  return text + "\n";
}

std::string log_line(const LogRow& row) {
  std::string text;
  for (const double value : row.values()) {
    if (!text.empty()) text += ',';
    fmt::format_to(std::back_inserter(text), "{}", value);  // shortest that reads back the same
  }
  return text + "\n";
}

std::vector<LogRow> read_log(const std::string& path) {
  CsvReader csv(path, CsvReader::LastLine::may_be_cut_off);
  const std::vector<std::size_t> columns = read_header(csv, path);
  std::vector<LogRow> rows;
  while (csv.next()) rows.push_back(row_of(csv, columns));
  return rows;
}

void check_log_header(const std::string& path) {
  CsvReader csv(path, CsvReader::LastLine::may_be_cut_off);
  if (read_header(csv, path).size() < observables().size())
    throw InputError({path, 1, ""}, "lacks columns that this version writes", other_log(path));
}

std::size_t column_of_log(const std::string& name, const InputError::Place& place) {
  std::vector<std::string> known;
  for (const Observable& o : observables()) known.push_back(o.name);
  const auto at = std::find(known.begin(), known.end(), name);
  if (at != known.end()) return static_cast<std::size_t>(at - known.begin());
  const std::string near = nearest_word(name, known);
  throw InputError(place, fmt::format("log.csv has no column \"{}\"", name),
                   near.empty() ? "see `ropewalk observe --list`" : fmt::format("did you mean \"{}\"?", near));
}

}  // namespace ropewalk
