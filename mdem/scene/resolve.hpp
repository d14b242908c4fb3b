// What acts in a scene, resolved to elements: all that another engine needs besides the state.
#pragma once

#include "scene/scene.hpp"
#include "sim/drive.hpp"
#include "sim/interaction.hpp"

namespace ropewalk {

// The reach of the contact viscosity must be set (build() does so).
Interaction interaction_of(const Scene& scene);

// Throws InputError for loads on elements that do not exist.
Drive drive_of(const Scene& scene, const Topology& topology);

}  // namespace ropewalk
