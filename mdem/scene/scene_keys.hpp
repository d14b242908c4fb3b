// Every key of a scene file: the one list behind the program's help, the templates and the remedies for keys
// that stand in the wrong table. The reader is scene_toml.cpp; scene_test.cpp holds the two together.
#pragma once

#include <string>
#include <vector>

namespace ropewalk {

struct SceneTable {
  std::string name;  // empty: the top of the file
  std::string meaning;

  std::string header() const { return name == "load" ? "[[load]]" : "[" + name + "]"; }
};

struct SceneKey {
  std::string table;
  std::string key;
  std::string unit;      // empty: none
  std::string value;     // the default as TOML, or an example of one
  std::string standard;  // what holds where the key is missing, in words; empty: `value`
  std::string meaning;

  bool required() const { return standard == "required"; }
};

const std::vector<SceneTable>& scene_tables();
const std::vector<SceneKey>& scene_keys();

// A table of all of them for the program's help.
std::string scene_key_help();

}  // namespace ropewalk
