#include "cases/common/straight_tubes.hpp"

#include "core/case_text.hpp"
#include "scene/kinds/rope.hpp"
#include "scene/scene_toml.hpp"

namespace ropewalk::validate {

BuiltScene straight_tubes(const ParameterSet& set, int elements, const Places& places) {
  static const Scene shipped = scene_of_text(case_scene("straight-tubes"), "straight-tubes/scene.toml");
  Scene scene = shipped;
  scene.sets = {set};
  scene.element_length = set.element_length;
  RopeSource rope;
  rope.tubes = static_cast<int>(places.size());
  rope.typed_places = places;
  rope.length = elements * set.element_length;
  scene.source = std::make_shared<RopeSource>(rope);
  return build(scene);
}

}  // namespace ropewalk::validate
