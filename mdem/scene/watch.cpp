#include "scene/watch.hpp"

#include "scene/build.hpp"
#include "scene/scene_to_model.hpp"

namespace ropewalk {
namespace {

// By tube types.
std::vector<double> rests(const Scene& scene) {
  std::vector<double> rest;
  if (scene.contact.law == ContactOptions::Law::paper)
    rest.push_back(pair_spacing(*scene.parameters().paper, scene.element_length));
  if (scene.contact.law == ContactOptions::Law::line)
    for (const LineContact& pair : line_contacts(scene)) rest.push_back(line_parallel_well(pair.density).distance);
  return rest;
}

// Down to the core gap of two tubes of the type.
double deepest_press(const Scene& scene, std::size_t type, const std::vector<double>& rest) {
  const ParameterSet& set = scene.sets[type];
  switch (scene.contact.law) {
    case ContactOptions::Law::paper:
      return rest[0] - (2 + set.paper->core_gap) * set.paper->radius;
    case ContactOptions::Law::line:
      return rest[type * (scene.sets.size() + 1)] - set.line->density.contact - set.line->density.core_gap;
    case ContactOptions::Law::none:
      break;
  }
  return 0;
}

}  // namespace

Watched watched_of(const Scene& scene, const Topology& topology) {
  Watched out;
  out.rest = rests(scene);
  for (std::size_t type = 0; type < scene.sets.size(); ++type) {
    Limits limits = default_limits(topology.types[type], scene.sets[type].validity);
    limits.press = deepest_press(scene, type, out.rest);
    for (std::size_t k = 0; k < limit_count; ++k)
      if (scene.limits[k]) limits.*limit_kinds()[k].limit = *scene.limits[k];
    out.limits.push_back(limits);
  }
  return out;
}

}  // namespace ropewalk
