// What a run of a scene watches: the defaults of observe/limits.hpp, and what [limits] says instead.
#pragma once

#include "observe/limits.hpp"
#include "scene/scene.hpp"

namespace ropewalk {

Watched watched_of(const Scene& scene, const Topology& topology);

}  // namespace ropewalk
