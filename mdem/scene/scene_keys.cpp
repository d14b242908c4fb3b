#include "scene/scene_keys.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "io/plain_text.hpp"
#include "scene/drive_kind.hpp"
#include "scene/kinds/scene_kind.hpp"
#include "scene/own_parts.hpp"
#include "scene/tables/tables.hpp"

namespace ropewalk {

bool SceneTable::optional() const {
  // Also "required but for ...".
  return listed || std::any_of(keys.begin(), keys.end(),
                               [](const SceneKey& k) { return k.standard.rfind("required", 0) == 0; });
}

std::string as_toml(double value) { return fmt::format("{:.6g}", value); }

namespace {

// Those of drives and kinds of one's own may have the name of another table: each register knows its own alone.
void refuse_like_names(const std::vector<SceneTable>& tables) {
  std::set<std::string> names;
  for (const SceneTable& t : tables) refuse_taken_name(!names.insert(t.name).second, "table", t.name);
}

}  // namespace

std::vector<SceneTable> scene_tables() {
  std::vector<SceneTable> tables = {top_table({}).doc()};
  for (const SceneKind& kind : scene_kinds()) tables.push_back(kind.table);
  for (const SceneTable& table :
       {start_table().doc(), bond_table().doc(), contact_table().doc(), damping_table().doc()})
    tables.push_back(table);
  tables.back().has_properties = true;  // [damping]
  for (const DriveKind& kind : drive_kinds()) {
    tables.push_back(kind.table());
    tables.back().has_properties = kind.has_properties();
  }
  for (const SceneTable& table : {run_table().doc(), statics_table().doc(), observe_table().doc(),
                                  limits_table().doc(), stop_table().doc(), expect_table().doc()})
    tables.push_back(table);
  refuse_like_names(tables);
  return tables;
}

std::vector<SceneKey> scene_keys() {
  std::vector<SceneKey> all;
  for (const SceneTable& t : scene_tables()) all.insert(all.end(), t.keys.begin(), t.keys.end());
  return all;
}

namespace {

std::string title_of(const SceneTable& t) {
  return within_width(t.name.empty() ? t.meaning + "\n" : fmt::format("{}  {}\n", t.header(), t.meaning));
}

// Key, unit and default, and the meaning behind them, or below where there is no room.
std::string line_of(const SceneKey& k) {
  const std::string begin =
      fmt::format("  {:31} {:10} {:30}", k.key, k.unit, k.standard.empty() ? k.value : k.standard);
  if (begin.size() <= 74 && begin.size() + 1 + k.meaning.size() <= widest_line) return begin + " " + k.meaning + "\n";
  std::string text = begin.substr(0, begin.find_last_not_of(' ') + 1);
  for (const std::string& line : lines_of(k.meaning, widest_line - 6)) text += "\n      " + line;
  return text + "\n";
}

}  // namespace

std::string scene_key_help() {
  std::string text =
      "Keys of a scene (TOML): name, unit, default, and below them the meaning. `ropewalk new` writes commented ones;\n"
      "`ropewalk help links` explains a table with an example.\n";
  for (const SceneTable& t : scene_tables()) {
    text += "\n" + title_of(t) + key_lines(t);
  }
  return text;
}

std::string key_lines(const SceneTable& table) {
  std::string text;
  for (const SceneKey& k : table.keys) text += line_of(k);
  return text;
}

std::string scene_key_help(const std::string& key) {
  std::string text;
  for (const SceneTable& t : scene_tables()) {
    std::string lines;
    for (const SceneKey& k : t.keys)
      if (k.key == key) lines += line_of(k);
    if (!lines.empty()) text += (text.empty() ? "" : "\n") + title_of(t) + lines;
  }
  return text;
}

}  // namespace ropewalk
