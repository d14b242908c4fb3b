// Builds the elements of a scene at time zero.
#pragma once

#include "scene/scene.hpp"
#include "sim/contact/contact_law.hpp"
#include "sim/state/state.hpp"

namespace ropewalk {

struct BuiltScene {
  Topology topology;
  State state;
  double spacing = 0;  // nm: distance of neighbouring parallel tubes, typed or parallel_spacing()
  std::shared_ptr<const ContactLaw> law;  // null: none
};

// Also sets the reach of the scene's contact viscosity, which goes with the spacing, its memory and its lineage.
BuiltScene build(Scene& scene);

}  // namespace ropewalk
