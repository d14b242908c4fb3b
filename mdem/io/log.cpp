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

constexpr const char* other_log = "is this a log.csv of this version of ropewalk?";
constexpr const char* damaged_log = "the file was changed or damaged; restore it, or run the scene again";

struct LineReader {
  const std::string& path;
  std::string_view line;
  int number;

  InputError error(const std::string& column, const std::string& what, const char* remedy) const {
    return InputError({path, number, column}, what, remedy);
  }

  double value(const LogColumn& column, std::string_view text) const {
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
    const std::vector<LogColumn>& columns = log_columns();
    const auto commas = static_cast<std::size_t>(std::count(line.begin(), line.end(), ','));
    if (commas + 1 != columns.size())
      throw error("", fmt::format("{} columns, {} are needed", commas + 1, columns.size()), damaged_log);
    std::string_view rest = line;
    for (const LogColumn& column : columns) {
      const std::size_t comma = rest.find(',');
      row.*column.value = value(column, rest.substr(0, comma));
      rest.remove_prefix(comma == std::string_view::npos ? rest.size() : comma + 1);
    }
    return row;
  }
};

// The line up to its newline; false where there is none any more. Takes Windows line ends as well.
bool take_line(std::string_view& text, std::string_view& line) {
  const std::size_t newline = text.find('\n');
  if (newline == std::string_view::npos) return false;
  line = text.substr(0, newline);
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  text.remove_prefix(newline + 1);
  return true;
}

void check_header(const std::string& path, std::string_view line) {
  const std::string expected = log_header();
  if (line == std::string_view(expected).substr(0, expected.size() - 1)) return;
  std::size_t column = 0;
  for (const LogColumn& c : log_columns()) {
    const std::size_t comma = line.find(',');
    const std::string_view name = line.substr(0, comma);
    if (name != c.name)
      throw InputError({path, 1, ""},
                       fmt::format("column {} of the header is \"{}\", \"{}\" is needed", column + 1,
                                   printable(std::string(name), 40), c.name),
                       other_log);
    line.remove_prefix(comma == std::string_view::npos ? line.size() : comma + 1);
    ++column;
  }
  throw InputError({path, 1, ""}, fmt::format("the header has more than {} columns", column), other_log);
}

}  // namespace

std::string log_header() {
  std::string text;
  for (const LogColumn& column : log_columns()) text += (text.empty() ? "" : ",") + std::string(column.name);
  return text + "\n";
}

std::string log_line(const LogRow& row) {
  std::string text;
  for (const LogColumn& column : log_columns()) {
    if (!text.empty()) text += ',';
    fmt::format_to(std::back_inserter(text), "{}", row.*column.value);  // shortest that reads back the same
  }
  return text + "\n";
}

std::vector<LogRow> read_log(const std::string& path) {
  const std::string content = read_file(path);
  std::string_view rest = content;
  std::string_view line;
  if (!take_line(rest, line)) throw InputError({path, 1, ""}, "there is no header", other_log);
  check_header(path, line);
  std::vector<LogRow> rows;
  for (int number = 2; take_line(rest, line); ++number) rows.push_back(LineReader{path, line, number}.row());
  return rows;
}

}  // namespace ropewalk
