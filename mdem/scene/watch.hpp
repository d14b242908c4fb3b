// The limits that a run of a scene watches: the defaults of observe/limits.hpp, or the values of [limits].
#pragma once

#include "observe/limits.hpp"
#include "scene/scene.hpp"
#include "sim/contact/contact_law.hpp"

namespace ropewalk {

// eV: what the tubes of a rope hold by their twist under the whole moment of the scene, M^2 L/2GJ of each; 0: no
// moment twists the scene, it is no rope, or heat moves it as well.
double twist_energy_of(const Scene& scene, const Topology& topology, const LoadsAndConstraints& loads);

// What holds each element; empty: there are no loads.
std::vector<Held> held_by(const LoadsAndConstraints& loads, const Topology& topology);

// `law`: that of the scene; null: none.
Watched watched_of(const Scene& scene, const Topology& topology, const LoadsAndConstraints& loads,
                   const ContactLaw* law);

}  // namespace ropewalk
