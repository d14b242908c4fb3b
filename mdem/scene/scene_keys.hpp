// Every key of a scene file.
#pragma once

#include "scene/scene_key.hpp"

namespace ropewalk {

// In the order of help and templates.
std::vector<SceneTable> scene_tables();
// The keys of all tables.
std::vector<SceneKey> scene_keys();

// A table of all of them for the program's help.
std::string scene_key_help();
// Of the scene's table of this name, as in "links" or "[links]", or of all keys of this name; empty: there are
// none.
std::string scene_key_help(const std::string& topic);

}  // namespace ropewalk
