#include "io/log.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <string_view>
#include <system_error>

#include "io/files.hpp"
#include "io/toml_table.hpp"
#include "model/error.hpp"

namespace ropewalk {
namespace {

constexpr const char* other_log =
    "is this the log.csv of a run by this version of ropewalk? If not, use the version in its manifest.json, or "
    "run "
    "the scene again";
constexpr const char* damaged_log = "the file was changed or damaged; restore it, or run the scene again";

struct LineReader {
  const std::string& path;
  std::string_view line;
  int number;

  InputError error(const std::string& column, const std::string& what, const char* remedy) const {
    return InputError({path, number, column}, what, remedy);
  }

  double value(const Observable& column, std::string_view text) const {
    double v = 0;
    const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), v);
    if (code != std::errc() || end != text.data() + text.size())
      throw error(column.name, fmt::format("\"{}\" is not a number", printable(std::string(text), 40)),
                  damaged_log);
    if (column.whole && std::isfinite(v) && v != std::floor(v))
      throw error(column.name, fmt::format("{} is not an integer", v), damaged_log);
    return v;
  }

  LogRow row() const {
    LogRow row;
    const std::size_t columns = row.values().size();
    const auto commas = static_cast<std::size_t>(std::count(line.begin(), line.end(), ','));
    if (commas + 1 != columns)
      throw error("", fmt::format("{} columns, {} are needed", commas + 1, columns), damaged_log);
    std::string_view rest = line;
    for (std::size_t k = 0; k < columns; ++k) {
      const std::size_t comma = rest.find(',');
      row.values()[k] = value(observables()[k], rest.substr(0, comma));
      rest.remove_prefix(comma == std::string_view::npos ? rest.size() : comma + 1);
    }
    return row;
  }
};

// Reads a line up to its newline; returns false if there is none left. Windows line ends are accepted.
bool take_line(std::string_view& text, std::string_view& line) {
  const std::size_t newline = text.find('\n');
  if (newline == std::string_view::npos) return false;
  line = text.substr(0, newline);
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  text.remove_prefix(newline + 1);
  return true;
}

void take_header(const std::string& path, std::string_view& text) {
  std::string_view line;
  if (!take_line(text, line)) throw InputError({path, 1, ""}, "there is no header", other_log);
  std::size_t number = 0;
  for (bool more = true; more; ++number) {
    const std::size_t comma = line.find(',');
    const std::string name(line.substr(0, comma));
    if (number == observables().size())
      throw InputError(
          {path, 1, ""},
          fmt::format("the header has more than {} columns: \"{}\" is not known", number, printable(name, 40)),
          other_log);
    if (name != observables()[number].name)
      throw InputError({path, 1, ""},
                       fmt::format("column {} of the header is \"{}\", \"{}\" is needed", number + 1,
                                   printable(name, 40), observables()[number].name),
                       other_log);
    more = comma != std::string_view::npos;
    line.remove_prefix(more ? comma + 1 : line.size());
  }
  if (number < observables().size())
    throw InputError(
        {path, 1, ""},
        fmt::format("the header ends after column {}, \"{}\" is needed next", number, observables()[number].name),
        other_log);
}

}  // namespace

LogRow::LogRow(const Measurement& measurement) {
  for (const Observable& observable : observables()) values_.push_back(observable.value(measurement));
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
  const std::string content = read_file(path);
  std::string_view rest = content;
  take_header(path, rest);
  std::vector<LogRow> rows;
  std::string_view line;
  for (int number = 2; take_line(rest, line); ++number) rows.push_back(LineReader{path, line, number}.row());
  return rows;
}

void check_log_header(const std::string& path) {
  const std::string content = read_file(path);
  std::string_view rest = content;
  take_header(path, rest);
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
