#include "plan/scene_edit.hpp"

#include <fmt/format.h>

#include <cstring>
#include <initializer_list>
#include <optional>
#include <vector>

#include "io/toml_text.hpp"
#include "model/error.hpp"

namespace ropewalk {
namespace {

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    lines.push_back(text.substr(at, end - at));
    at = end + 1;
  }
  return lines;
}

std::string text_of(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

bool is_header(const std::string& line) {
  const std::size_t at = line.find_first_not_of(" \t");
  return at != std::string::npos && line[at] == '[';
}

// Whether these words come first, with blanks between them or not.
bool starts_with(const std::string& line, std::initializer_list<const char*> words) {
  std::size_t at = 0;
  for (const char* word : words) {
    while (at < line.size() && (line[at] == ' ' || line[at] == '\t')) ++at;
    const std::size_t length = std::strlen(word);
    if (line.compare(at, length, word) != 0) return false;
    at += length;
  }
  return true;
}

// The lines of a table after its header, [from, to); none: from = npos.
struct LineRange {
  std::size_t from = std::string::npos, to = 0;
};

LineRange range_of(const std::vector<std::string>& lines, const std::string& table) {
  LineRange r;
  if (table.empty()) r.from = 0;
  for (r.to = 0; r.to < lines.size(); ++r.to) {
    if (!is_header(lines[r.to])) continue;
    if (r.from != std::string::npos) return r;
    if (starts_with(lines[r.to], {"[", table.c_str(), "]"})) r.from = r.to + 1;
  }
  return r;
}

std::size_t find_key(const std::vector<std::string>& lines, const LineRange& r, const std::string& key,
                     bool comment) {
  for (std::size_t k = r.from; k < r.to; ++k)
    if (starts_with(lines[k], {comment ? "#" : "", key.c_str(), "="})) return k;
  return std::string::npos;
}

// Sets a key in the range of its table by this line; where the range is empty, the table is made at the end.
void set_line(std::vector<std::string>& lines, const LineRange& r, const std::string& table, const std::string& key,
              const std::string& line) {
  if (r.from == std::string::npos) {
    lines.insert(lines.end(), {"", "[" + table + "]", line});
    return;
  }
  for (const bool comment : {false, true}) {
    const std::size_t at = find_key(lines, r, key, comment);
    if (at == std::string::npos) continue;
    lines[at] = line;
    return;
  }
  lines.insert(lines.begin() + static_cast<std::ptrdiff_t>(r.from), line);
}

// --- Paths ---

std::vector<std::string> parts_of(const std::string& path) {
  std::vector<std::string> parts(1);
  for (const char c : path)
    if (c == '.')
      parts.emplace_back();
    else
      parts.back() += c;
  return parts;
}

std::string joined(const std::vector<std::string>& parts, std::size_t from, std::size_t to) {
  std::string text;
  for (std::size_t k = from; k < to; ++k) text += (k > from ? "." : "") + parts[k];
  return text;
}

int line_of(const toml::source_position& at) { return static_cast<int>(at.line); }

// Null where the table lacks it.
const toml::node* child(const toml::node& node, const std::vector<std::string>& parts, std::size_t depth,
                        const std::string& path, const std::string& file) {
  const std::string& part = parts[depth];
  if (const toml::table* table = node.as_table()) return table->get(part);
  const toml::array* list = node.as_array();
  if (!list)
    throw InputError({file, line_of(node.source().begin), path},
                     fmt::format("\"{}\" is not a table", joined(parts, 0, depth)), "name the key itself");
  const bool number = !part.empty() && part.find_first_not_of("0123456789") == std::string::npos && part.size() < 9;
  const std::size_t index = number ? std::stoul(part) : list->size();
  if (index < list->size()) return list->get(index);
  throw InputError({file, line_of(node.source().begin), path},
                   fmt::format("\"{}\" is a list of {}", joined(parts, 0, depth), list->size()),
                   fmt::format("write a number from 0 to {} after it", list->size() - 1));
}

// The whole file, or a table with a [header].
bool has_lines_below(const toml::node& node, const toml::table& top) {
  const toml::table* table = node.as_table();
  return &node == &top || (table && !table->is_inline()) || node.is_array_of_tables();
}

LineRange range_from(const std::vector<std::string>& lines, std::size_t first) {
  LineRange r{first, first};
  while (r.to < lines.size() && !is_header(lines[r.to])) ++r.to;
  return r;
}

// Columns count characters, not bytes.
std::size_t byte_of(const std::string& line, std::size_t column) {
  std::size_t at = 0;
  for (std::size_t k = 1; k < column && at < line.size(); ++k) do
      ++at;
    while (at < line.size() && (static_cast<unsigned char>(line[at]) & 0xC0) == 0x80);
  return at;
}

std::string replaced(std::vector<std::string> lines, const toml::source_region& at, const std::string& value) {
  const std::string &first = lines[at.begin.line - 1], &last = lines[at.end.line - 1];
  const std::string line =
      first.substr(0, byte_of(first, at.begin.column)) + value + last.substr(byte_of(last, at.end.column));
  lines.erase(lines.begin() + at.begin.line, lines.begin() + at.end.line);
  lines[at.begin.line - 1] = line;
  return text_of(lines);
}

}  // namespace

std::string with_key(const std::string& text, const std::string& table, const std::string& key,
                     const std::string& value) {
  std::vector<std::string> lines = lines_of(text);
  set_line(lines, range_of(lines, table), table, key, key + " = " + value);
  return text_of(lines);
}

std::string with_value(const std::string& text, const std::string& path, const std::string& value,
                       const std::string& file) {
  const toml::table top = parsed_toml(text, file);
  const std::vector<std::string> parts = parts_of(path);
  const toml::node* node = &top;
  std::size_t depth = 0;
  for (; depth < parts.size(); ++depth) {
    const toml::node* next = child(*node, parts, depth, path, file);
    if (!next) break;
    node = next;
  }
  std::vector<std::string> lines = lines_of(text);
  const toml::source_region at = node->source();
  if (depth == parts.size()) {
    if (has_lines_below(*node, top))
      throw InputError({file, line_of(at.begin), path}, "is a table", "name a key in it");
    return replaced(lines, at, value);
  }
  const std::string key = joined(parts, depth, parts.size());
  if (!has_lines_below(*node, top)) {
    const toml::source_region brace{at.begin, {at.begin.line, at.begin.column + 1}, at.path};
    const bool empty = node->as_table()->empty();
    return replaced(lines, brace, fmt::format("{{ {} = {}{}", key, value, empty ? "" : ","));
  }
  if (depth == 0 && parts.size() > 1) {
    const std::string leaf = joined(parts, 1, parts.size());
    set_line(lines, {}, parts[0], leaf, leaf + " = " + value);
  } else {
    set_line(lines, range_from(lines, depth == 0 ? 0 : at.begin.line), "", key, key + " = " + value);
  }
  return text_of(lines);
}

double number_at(const std::string& text, const std::string& path, const std::string& file) {
  const toml::table top = parsed_toml(text, file);
  const std::vector<std::string> parts = parts_of(path);
  const toml::node* node = &top;
  for (std::size_t depth = 0; depth < parts.size() && node; ++depth) node = child(*node, parts, depth, path, file);
  if (const toml::table* table = node ? node->as_table() : nullptr) node = table->get("value");
  const std::optional<double> value = node ? node->value<double>() : std::nullopt;
  if (!value) throw InputError({file, 0, path}, "is not a number there", "write one");
  return *value;
}

}  // namespace ropewalk
