#include "io/csv_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <system_error>

#include "io/files.hpp"
#include "io/plain_text.hpp"
#include "model/error.hpp"

namespace ropewalk {
namespace {

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

}  // namespace

CsvReader::CsvReader(const std::string& path, LastLine last)
    : path_(path), text_(read_file(path)), rest_(text_), last_(last) {
  if (rest_.substr(0, 3) == "\xef\xbb\xbf") rest_.remove_prefix(3);
}

bool CsvReader::next() {
  comments_.clear();
  while (!rest_.empty()) {
    const std::size_t newline = rest_.find('\n');
    if (newline == std::string_view::npos && last_ == LastLine::may_be_cut_off) break;
    line_ = trimmed(rest_.substr(0, newline));
    rest_.remove_prefix(newline == std::string_view::npos ? rest_.size() : newline + 1);
    ++number_;
    if (line_.empty()) continue;
    if (line_[0] == '#') {
      comments_.push_back(trimmed(line_.substr(1)));
      continue;
    }
    split(line_);
    return true;
  }
  line_ = {};
  cells_.clear();
  return false;
}

// A cell that begins with a quote, up to the comma behind it.
std::string_view CsvReader::take_quoted(std::string_view& line) {
  std::string& cell = unquoted_.emplace_back();
  for (std::size_t at = line.find('"') + 1;;) {
    const std::size_t quote = line.find('"', at);
    if (quote == std::string_view::npos) fail("", "holds a quote that does not end", "end it");
    cell += line.substr(at, quote - at);
    at = quote + 1;
    if (line.substr(at, 1) == "\"") {
      cell += '"';
      ++at;
      continue;
    }
    const std::size_t comma = std::min(line.find(',', at), line.size());
    if (!trimmed(line.substr(at, comma - at)).empty())
      fail("", "holds text behind a quote", "put a comma between cells");
    line.remove_prefix(comma);
    return cell;
  }
}

void CsvReader::split(std::string_view line) {
  cells_.clear();
  unquoted_.clear();
  for (;;) {
    if (trimmed(line).substr(0, 1) == "\"") {
      cells_.push_back(take_quoted(line));
    } else {
      const std::size_t comma = std::min(line.find(','), line.size());
      cells_.push_back(trimmed(line.substr(0, comma)));
      line.remove_prefix(comma);
    }
    if (has_control_character(cells_.back()))
      fail("", "holds a control character", "write plain text, with commas between columns");
    if (line.empty()) return;
    line.remove_prefix(1);
  }
}

double CsvReader::number(std::size_t cell, std::string_view column, const char* remedy) const {
  const std::string_view text = cells_[cell];
  // from_chars takes no plus sign.
  const std::string_view digits = !text.empty() && text[0] == '+' ? text.substr(1) : text;
  double value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (digits.empty() || error != std::errc() || end != digits.data() + digits.size())
    fail(column, fmt::format("\"{}\" is not a number", printable(std::string(text), 40)), remedy);
  return value;
}

double CsvReader::finite_number(std::size_t cell, std::string_view column, const char* remedy) const {
  const double value = number(cell, column, remedy);
  if (!std::isfinite(value))
    fail(column, fmt::format("\"{}\" is not a finite number", printable(std::string(cells_[cell]), 40)), remedy);
  return value;
}

InputError CsvReader::error(std::string_view column, const std::string& what, const std::string& remedy) const {
  return {{path_, number_, std::string(column)}, what, remedy};
}

void CsvReader::fail(std::string_view column, const std::string& what, const std::string& remedy) const {
  throw error(column, what, remedy);
}

std::string csv_cell(const std::string& text) {
  // A table calculation takes a text that begins so for a formula; of numbers it does not.
  double number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  const bool is_number = error == std::errc() && end == text.data() + text.size();
  if (!is_number && text.find_first_of("=+-@") == 0) return csv_cell("'" + text);
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + "\"";
}

}  // namespace ropewalk
