// Refuses scenes in which one table undoes the load or the motion that another one gives to an element.
#pragma once

#include "scene/scene.hpp"
#include "sim/dynamics/loads.hpp"

namespace ropewalk {

// Throws InputError where a clamp and a [[load]] both say how an element moves, and where nothing feels a force or a
// couple: others hold all of its elements.
void refuse_loads(const Scene& scene, const Topology& topology, const Interaction& interaction,
                  const LoadsAndConstraints& all);

}  // namespace ropewalk
