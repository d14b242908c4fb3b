// The tables of docs/outputs.md, to compare with those in the code.
#pragma once

#include <fstream>
#include <set>
#include <sstream>
#include <string>

namespace ropewalk::test {

// The table below the heading, up to the next heading; empty where there is none.
inline std::string outputs_table(const std::string& heading) {
  std::ifstream page(ROPEWALK_SOURCE_DIR "/docs/outputs.md");
  std::string table, line;
  bool here = false;
  while (std::getline(page, line)) {
    if (line[0] == '#') here = line.substr(line.find(' ') + 1) == heading;
    if (here && line[0] == '|') table += line + "\n";
  }
  return table;
}

// The names in its first column.
inline std::set<std::string> outputs_names(const std::string& heading) {
  std::set<std::string> names;
  std::istringstream table(outputs_table(heading));
  for (std::string line; std::getline(table, line);)
    if (line.rfind("| `", 0) == 0) names.insert(line.substr(3, line.find('`', 3) - 3));
  return names;
}

// The keys of a JSON object.
template <class Json>
std::set<std::string> keys_of(const Json& object) {
  std::set<std::string> keys;
  for (const auto& entry : object.items()) keys.insert(entry.key());
  return keys;
}

}  // namespace ropewalk::test
