#include "plan/scene_edit.hpp"

#include <regex>
#include <vector>

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

// The lines of a table after its header, [from, to); none: from = npos.
struct LineRange {
  std::size_t from = std::string::npos, to = 0;
};

LineRange range_of(const std::vector<std::string>& lines, const std::string& table) {
  LineRange r;
  if (table.empty()) r.from = 0;
  const std::regex header("\\s*\\[\\s*" + table + "\\s*\\]\\s*(#.*)?");
  for (r.to = 0; r.to < lines.size(); ++r.to) {
    if (!is_header(lines[r.to])) continue;
    if (r.from != std::string::npos) return r;
    if (std::regex_match(lines[r.to], header)) r.from = r.to + 1;
  }
  return r;
}

std::size_t find_key(const std::vector<std::string>& lines, const LineRange& r, const std::string& key, bool comment) {
  const std::regex sets(std::string(comment ? "\\s*#\\s*" : "\\s*") + key + "\\s*=.*");
  for (std::size_t k = r.from; k < r.to; ++k)
    if (std::regex_match(lines[k], sets)) return k;
  return std::string::npos;
}

}  // namespace

std::string with_key(const std::string& text, const std::string& table, const std::string& key,
                     const std::string& value) {
  std::vector<std::string> lines = lines_of(text);
  const std::string line = key + " = " + value + "  # planned";
  LineRange r = range_of(lines, table);
  if (r.from == std::string::npos) {
    lines.push_back("");
    lines.push_back("[" + table + "]");
    lines.push_back(line);
    return text_of(lines);
  }
  for (const bool comment : {false, true}) {
    const std::size_t at = find_key(lines, r, key, comment);
    if (at == std::string::npos) continue;
    lines[at] = line;
    return text_of(lines);
  }
  lines.insert(lines.begin() + static_cast<std::ptrdiff_t>(r.from), line);
  return text_of(lines);
}

std::string without_key(const std::string& text, const std::string& table, const std::string& key) {
  std::vector<std::string> lines = lines_of(text);
  const LineRange r = range_of(lines, table);
  if (r.from == std::string::npos) return text;
  const std::size_t at = find_key(lines, r, key, false);
  if (at == std::string::npos) return text;
  lines[at] = "# " + lines[at];
  return text_of(lines);
}

}  // namespace ropewalk
