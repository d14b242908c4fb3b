// The limits that a run of a scene watches: the defaults of observe/limits.hpp, or the values of [limits].
#pragma once

#include "observe/limits.hpp"
#include "scene/scene.hpp"
#include "sim/contact/contact_law.hpp"

namespace ropewalk {

// `law`: that of the scene; null: none.
Watched watched_of(const Scene& scene, const Topology& topology, const ContactLaw* law);

}  // namespace ropewalk
