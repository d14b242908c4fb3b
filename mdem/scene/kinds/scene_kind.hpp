// Where the elements of a scene come from, and the register of such kinds. A kind is one file: its class, its keys
// and its entry here; [rope], [film], [chain] and [state] are the shipped ones.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "scene/key_table.hpp"
#include "scene/random.hpp"
#include "sim/state/state.hpp"

namespace ropewalk {

class Source {
 public:
  struct Sizes {
    int tubes = 0, elements = 0;  // elements of each tube
  };

  virtual ~Source() = default;
  // With elements of this length (nm). Zeros where only place() knows.
  virtual Sizes sizes(double /*element_length*/) const { return {}; }
  // Adds the tubes to `topology`, which has the scene's types, and puts their elements in place; whatever `state`
  // held is gone. `spacing` (nm) is that of neighbouring parallel tubes.
  virtual void place(const Scene& scene, double spacing, Random& random, Topology& topology,
                     State& state) const = 0;

  // Of neighbouring parallel tubes, nm; 0: where two of them bind best.
  virtual double typed_spacing() const { return 0; }
  // Whether all tubes are straight and parallel to z.
  virtual bool is_parallel() const { return false; }
  // That the elements are read from; empty: there is none.
  virtual std::string file() const { return ""; }
  // For the user, of what was placed.
  virtual std::string description(const Topology&, const State&, double /*spacing*/) const { return ""; }
};

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

double largest_radius(const Scene& scene);  // nm, of the tube types

// Refuses more elements than fit, before anything is allocated.
void check_size(const TomlTable& t, const std::string& key, double tubes, double elements);

// [diameter, 10 diameters] of the thickest tube: distances of tube axes.
Bounds spacing_bounds(const Scene& scene);

// Straight tubes along z, their middles in the plane z = 0.
void add_straight_tubes(const std::vector<std::pair<double, double>>& places, int elements, double element_length,
                        Topology& topology, State& state);

}  // namespace ropewalk
