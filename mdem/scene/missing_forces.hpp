// Forces of one's own that a run had (Scene::missing_forces): functions of Python, which no file holds.
#pragma once

#include <string>

namespace ropewalk {

// Throws InputError for the scene or the directory `path` where a run had such forces, named `forces`.
void refuse_missing_forces(const std::string& forces, const std::string& path);

}  // namespace ropewalk
