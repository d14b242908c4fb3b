// The parts of a program of one's own (scene/own_parts.hpp) that a scene uses.
#pragma once

#include <string>
#include <vector>

#include "scene/scene.hpp"

namespace ropewalk {

struct PartInUse {
  std::string words;  // "load wind"
  std::string key;    // that names it in the scene: "load.kind"
};
std::vector<PartInUse> parts_in_use(const Scene& scene);

// "load wind, drive trap": what a program needs to read a run of the scene. Drives with columns in the log count
// although the scene does not use them.
std::string own_parts_of_run(const Scene& scene);

}  // namespace ropewalk
