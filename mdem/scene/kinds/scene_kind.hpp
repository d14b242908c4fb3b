// The register of kinds of scenes (scene/source.hpp). A kind is one file: its class, its keys and its entry here;
// [rope], [plies], [film], [chain] and [state] are the shipped ones.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "scene/key_table.hpp"
#include "scene/random.hpp"
#include "scene/source.hpp"

namespace ropewalk {

struct SceneKind {
  SceneTable table;
  std::function<std::shared_ptr<const Source>(const TomlTable&, const Scene&)> read;
};

template <class S>
SceneKind scene_kind(const KeyTable<S>& table) {
  return {table.doc(), [table](const TomlTable& t, const Scene& scene) {
            return std::make_shared<const S>(table.read(t, scene));
          }};
}

// The shipped kinds, and those that were added.
const std::vector<SceneKind>& scene_kinds();
// For kinds from elsewhere; returns true, so that a static variable can do it. The name must be new.
bool add_scene_kind(SceneKind kind);

// The one kind of the scene: sets Scene::kind and Scene::source.
void read_source(const TomlTable& top, Scene& scene);

// The key that says how long the tubes of the scene's kind are.
SceneKey tube_size_key(const Scene& scene);

// --- for kinds ---

// Refuses more elements than fit, before anything is allocated.
void check_size(const TomlTable& t, const std::string& key, double tubes, double elements);

// [diameter, 10 diameters] of the thickest tube: distances of tube axes.
Bounds spacing_bounds(const Scene& scene);

// Straight tubes along z, their middles in the plane z = 0.
void add_straight_tubes(const std::vector<std::pair<double, double>>& places, int elements, double element_length,
                        Topology& topology, State& state);

}  // namespace ropewalk
