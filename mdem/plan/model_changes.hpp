// Changes that `plan` may make in a model, and the model that the program chooses where nothing is typed.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "plan/planned_scene.hpp"

namespace ropewalk {

// One change of the default model. Of two with the same key only one can be taken.
struct ModelChange {
  std::string key;   // of the scene: "element_length_nm"
  std::string name;  // "elements twice as long"
  std::function<void(PlannedScene&)> write;
};

// The changes that make the scene cheaper. `end_state`: its motion does not matter. `not_tried` gets a sentence for
// each change that was left out, with the reason.
std::vector<ModelChange> cheaper_changes(const Scene& scene, const SceneFeatures& features, bool end_state,
                                         std::vector<std::string>& not_tried);

// Why `plan` keeps the element length; empty: it varies the length.
std::string kept_length(const Scene& scene);

// Elements half as long, where they may be; else more nodes of the law. And half the time step.
std::vector<ModelChange> finest_changes(const Scene& scene, const SceneFeatures& features);

// The scene with the program's own choice in all that `plan` may change, and then the changes.
std::string text_with(const Scene& scene, const SceneFeatures& features, const std::vector<ModelChange>& changes,
                      std::vector<std::string>* why = nullptr);

// The time step so many times as long as the default's, never beyond the part of the limit that the program takes.
ModelChange step_change(double times);

// Why a relaxation cannot replace the motion; empty: it can.
std::string needs_time(const Scene& scene);

}  // namespace ropewalk
