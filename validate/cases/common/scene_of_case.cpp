#include "cases/common/scene_of_case.hpp"

#include "core/case_text.hpp"
#include "plan/scene_edit.hpp"

namespace ropewalk::validate {

Scene scene_of_case(const std::string& name, const ParameterSet& set, const ChangedValues& values) {
  const std::string file = name + "/scene.toml";
  std::string text = case_scene(name);
  for (const auto& [path, value] : values) text = with_value(text, path, value, file);
  Scene scene = scene_of_text(text, file, {set.path});
  scene.sets = {set};
  return scene;
}

}  // namespace ropewalk::validate
