// Reading a scene. The keys are listed in scene/scene_keys.cpp.
#pragma once

#include <string>
#include <vector>

#include "model/error.hpp"
#include "scene/scene.hpp"
#include "scene/scene_keys.hpp"

namespace ropewalk {

// Where the shipped sets and scenes lie: the environment variable ROPEWALK_DATA, or the source tree's data/.
std::string data_directory();

// The file of a parameter set: `name` as a file in `folder` (empty: the current one), then as the name of a
// shipped set. Throws InputError at `place` where there is neither.
std::string find_parameters(const std::string& name, const std::string& folder,
                            const InputError::Place& place = {"", 0, "--parameters"},
                            const std::string& data = data_directory());

// Throws InputError for anything that is not right, unknown keys included. `parameters` are read instead of the
// sets that the scene names where it is not empty (a run directory keeps its own copies).
Scene read_scene(const std::string& path, const std::vector<std::string>& parameters = {});

}  // namespace ropewalk
