// What one table of a scene does to an element and another one undoes.
#pragma once

#include "scene/scene.hpp"
#include "sim/dynamics/loads.hpp"

namespace ropewalk {

// Throws InputError where a clamp and a [[load]] both say how an element moves, and where nothing feels a force or a
// couple: others hold all of its elements.
void refuse_loads(const Scene& scene, const Topology& topology, const Interaction& interaction,
                  const LoadsAndConstraints& all);

}  // namespace ropewalk
