#include "io/log.hpp"

#include <fmt/format.h>

#include <charconv>
#include <string_view>

#include "io/files.hpp"
#include "model/error.hpp"

namespace ropewalk {
namespace {

constexpr const char* remedy = "the file is not a log of this version; run the scene again";

std::vector<std::string_view> split(std::string_view line) {
  std::vector<std::string_view> parts;
  for (;;) {
    const std::size_t comma = line.find(',');
    parts.push_back(line.substr(0, comma));
    if (comma == std::string_view::npos) return parts;
    line.remove_prefix(comma + 1);
  }
}

double number(std::string_view text, const InputError::Place& place) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size())
    throw InputError(place, fmt::format("'{}' is not a number", text), remedy);
  return value;
}

LogRow parse(std::string_view line, const std::string& path, int line_number) {
  const auto parts = split(line);
  const auto& columns = log_columns();
  if (parts.size() != columns.size())
    throw InputError({path, line_number, ""}, fmt::format("has {} columns instead of {}", parts.size(), columns.size()),
                     remedy);
  LogRow row;
  for (std::size_t k = 0; k < columns.size(); ++k)
    row.*columns[k].value = number(parts[k], {path, line_number, columns[k].name});
  return row;
}

}  // namespace

std::string log_header() {
  std::string text;
  for (const LogColumn& c : log_columns()) text += (text.empty() ? "" : ",") + std::string(c.name);
  return text + "\n";
}

std::string log_line(const LogRow& row) {
  std::string text;
  for (const LogColumn& c : log_columns()) {
    const double value = row.*c.value;
    if (!text.empty()) text += ',';
    text += c.whole ? fmt::format("{:.0f}", value) : fmt::format("{}", value);
  }
  return text + "\n";
}

std::vector<LogRow> read_log(const std::string& path) {
  const std::string text = read_file(path);
  std::vector<LogRow> rows;
  std::string_view rest(text);
  for (int line = 1; !rest.empty(); ++line) {
    const std::size_t end = rest.find('\n');
    if (end == std::string_view::npos)
      throw InputError({path, line, ""}, "the last line is not complete", "go on with `ropewalk resume`, which mends it");
    const std::string_view one = rest.substr(0, end);
    rest.remove_prefix(end + 1);
    if (line == 1) {
      if (std::string(one) + "\n" != log_header()) throw InputError({path, 1, ""}, "has another header", remedy);
      continue;
    }
    rows.push_back(parse(one, path, line));
  }
  return rows;
}

}  // namespace ropewalk
