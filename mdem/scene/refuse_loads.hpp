// What one table of a scene does to an element and another one undoes.
#pragma once

#include "scene/prepare.hpp"

namespace ropewalk {

// Throws InputError where a clamp and a [[load]] both say how an element moves, and where nothing feels a force or a
// couple: others hold all of its elements.
void refuse_loads(const Scene& scene, const Prepared& prepared);

}  // namespace ropewalk
