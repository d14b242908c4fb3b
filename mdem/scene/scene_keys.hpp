// Every key of a scene file.
#pragma once

#include "scene/scene_key.hpp"

namespace ropewalk {

// All tables of a scene, in the order of help and templates.
std::vector<SceneTable> scene_tables();
// The keys of all tables.
std::vector<SceneKey> scene_keys();

// A table of all of them for the program's help.
std::string scene_key_help();
// The help of all keys of this name; empty: there are none.
std::string scene_key_help(const std::string& key);
// A line or two for each key of a table.
std::string key_lines(const SceneTable& table);

}  // namespace ropewalk
