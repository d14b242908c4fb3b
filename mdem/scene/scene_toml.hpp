// Reading a scene. The keys are listed in scene/scene_keys.cpp.
#pragma once

#include <string>
#include <vector>

#include "io/data_files.hpp"
#include "model/error.hpp"
#include "scene/scene.hpp"
#include "scene/scene_keys.hpp"

namespace ropewalk {

// Throws InputError for anything that is not right, unknown keys included. `parameters` are read instead of the
// sets that the scene names where it is not empty (a run directory keeps its own copies).
Scene read_scene(const std::string& path, const std::vector<std::string>& parameters = {});

// The same for a text; `path` names it in errors, and files are looked for beside it.
Scene scene_of_text(const std::string& text, const std::string& path,
                    const std::vector<std::string>& parameters = {});

}  // namespace ropewalk
