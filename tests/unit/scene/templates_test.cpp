// Numbers of scenes that are wrong by a factor: refused, or their keys stand in a list that users read.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cctype>
#include <cmath>
#include <map>

#include "io/files.hpp"
#include "model/error.hpp"
#include "plan/forecast.hpp"
#include "scene/prepare.hpp"
#include "scene/scene_toml.hpp"
#include "scene/templates.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

constexpr std::array<double, 3> factors = {10, 0.1, -1};

// A number in the text of a scene. `key`: "grip.z.strain".
struct Number {
  std::string key;
  std::size_t at = 0, length = 0;
  double value = 0;
};

std::string trimmed(const std::string& text) {
  const std::size_t begin = text.find_first_not_of(" ["), end = text.find_last_not_of(" ]");
  return begin == std::string::npos ? "" : text.substr(begin, end + 1 - begin);
}

// Adds the numbers of a line `key = value`, whose value may be a table.
void add_numbers(const std::string& table, const std::string& line, std::size_t line_at, std::vector<Number>& all) {
  std::string key, inner, word;
  bool quoted = false, in_table = false;
  for (std::size_t k = 0; k < line.size(); ++k) {
    const char c = line[k];
    if (c == '"') quoted = !quoted;
    if (c == '#' && !quoted) return;
    if (quoted) continue;
    if (c == '{') in_table = true;
    if (c == '=') {
      (key.empty() ? key : inner) = word;
      word.clear();
    } else if (std::isalpha(static_cast<unsigned char>(c)) || (c == '_' && !word.empty())) {
      while (k < line.size() && (std::isalnum(static_cast<unsigned char>(line[k])) || line[k] == '_')) word += line[k++];
      --k;
      const std::size_t next = line.find_first_not_of(' ', k + 1);
      if (next == std::string::npos || line[next] != '=') word.clear();
    } else if (!key.empty() && (std::isdigit(static_cast<unsigned char>(c)) || c == '-')) {
      std::size_t length = 0;
      const double value = std::stod(line.substr(k), &length);
      const std::string name = in_table ? key + "." + inner : key;
      if (value != 0) all.push_back({table.empty() ? name : table + "." + name, line_at + k, length, value});
      k += length - 1;
    }
  }
}

std::vector<Number> numbers_of(const std::string& text) {
  std::vector<Number> all;
  std::string table;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::string line = text.substr(at, end - at);
    if (line[0] == '[')
      table = trimmed(line.substr(0, line.find('#')));
    else if (!line.empty() && line[0] != '#')
      add_numbers(table, line, at, all);
    at = end + 1;
  }
  return all;
}

bool is_taken(const std::string& text) {
  try {
    Scene scene = scene_of_text(text, "s.toml");
    refuse_cooling(scene, prepare(scene));
    return true;
  } catch (const InputError&) {
    return false;
  }
}

TEST(Scenes, NumbersThatNothingHoldsArePrinted) {
  std::map<std::string, std::array<bool, factors.size()>> taken;
  int tried = 0;
  for (const SceneTemplate& kind : scene_templates())
    for (const Number& n : numbers_of(kind.brief)) {
      if (n.key.rfind("expect.", 0) == 0) continue;  // what the run is judged by, not what it does
      for (std::size_t f = 0; f < factors.size(); ++f) {
        bool& there = taken[n.key][f];
        if (there) continue;
        std::string changed = kind.brief;
        changed.replace(n.at, n.length, fmt::format("{:.15g}", factors[f] * n.value));
        there = is_taken(changed);
        ++tried;
      }
    }
  EXPECT_GT(tried, 200);
  std::string table;
  for (const auto& [key, by] : taken) {
    if (!by[0] && !by[1] && !by[2]) continue;
    table += fmt::format("| `{}` |", key);
    for (const bool yes : by) table += yes ? " taken |" : " |";
    table += "\n";
  }
  EXPECT_NE(read_file(ROPEWALK_SOURCE_DIR "/docs/faults.md").find("|---|---|---|---|\n" + table), std::string::npos)
      << "docs/faults.md should have\n"
      << table;
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
