// What a run of a scene watches: the defaults of observe/limits.hpp, and what [limits] says instead.
#pragma once

#include "observe/limits.hpp"
#include "scene/scene.hpp"
#include "sim/contact/contact_law.hpp"

namespace ropewalk {

// `law`: that of the scene; null: none.
Watched watched_of(const Scene& scene, const Topology& topology, const ContactLaw* law);

}  // namespace ropewalk
