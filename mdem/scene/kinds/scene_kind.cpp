#include "scene/kinds/scene_kind.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "scene/bounds.hpp"
#include "scene/memory_size.hpp"
#include "scene/own_parts.hpp"
#include "scene/scene.hpp"
#include "scene/spacing.hpp"

namespace ropewalk {

// One line for each shipped kind, and one below.
SceneKind rope_kind();
SceneKind plies_kind();
SceneKind film_kind();
SceneKind chain_kind();
SceneKind state_kind();

namespace {

std::vector<SceneKind>& kinds_of_scenes() {
  static std::vector<SceneKind> kinds = {
      rope_kind(), plies_kind(), film_kind(), chain_kind(), state_kind(),
  };
  return kinds;
}

// [a], [b] and [c].
std::string headers() {
  std::string text;
  const std::size_t kinds = scene_kinds().size();
  for (std::size_t k = 0; k < kinds; ++k)
    text += (k == 0 ? "" : k + 1 == kinds ? " and " : ", ") + scene_kinds()[k].table.header();
  return text;
}

[[noreturn]] void refuse_no_source(const TomlTable& top) {
  std::vector<std::string> names;
  for (const SceneKind& kind : scene_kinds()) names.push_back(kind.table.name);
  for (const std::string& key : top.keys()) {
    const std::string near = nearest_word(key, names);
    if (!near.empty()) throw top.error(key, "unknown table", fmt::format("did you mean \"{}\"?", near));
  }
  throw top.error("", "there is nothing in the scene", "add one of the tables " + headers());
}

}  // namespace

const std::vector<SceneKind>& scene_kinds() { return kinds_of_scenes(); }

bool add_scene_kind(SceneKind kind) {
  return add_own_part(kinds_of_scenes(), std::move(kind), "scene kind",
                      [](const SceneKind& k) { return k.table.name; });
}

void read_source(const TomlTable& top, Scene& scene) {
  std::vector<const SceneKind*> named;
  for (const SceneKind& kind : scene_kinds())
    if (top.has(kind.table.name)) named.push_back(&kind);
  if (named.empty()) refuse_no_source(top);
  if (named.size() > 1)
    throw top.error(named[1]->table.name, fmt::format("stands beside {}", named[0]->table.header()),
                    "a scene has exactly one of " + headers());
  scene.kind = named[0]->table.name;
  scene.source = named[0]->read(top.table(scene.kind), scene);
}

SceneKey tube_size_key(const Scene& scene) {
  for (const SceneKind& kind : scene_kinds())
    for (const SceneKey& key : kind.table.keys)
      if (kind.table.name == scene.kind && key.tube_size != SceneKey::TubeSize::no) return key;
  return {};
}

void check_size(const TomlTable& t, const std::string& key, double tubes, double elements) {
  const double total = tubes * elements;
  const std::string asks = fmt::format("asks for {:.0f} x {:.0f} = {:.3g} elements", tubes, elements, total);
  if (total > max_elements)
    throw t.error(key, asks,
                  fmt::format("at most {:.0e} are allowed; these would take about {:.3g} GB", double{max_elements},
                              1e-9 * memory_needed(total)));
  if (const std::string memory = beyond_memory(total); !memory.empty())
    throw t.error(key, asks + ", " + memory, "take fewer or shorter tubes or longer elements, or another machine");
}

Bounds spacing_bounds(const Scene& scene) {
  const double diameter = 2 * largest_radius(scene);
  return {diameter, 10 * diameter, true};
}

void add_straight_tubes(const std::vector<std::pair<double, double>>& places, int elements, double element_length,
                        Topology& topology, State& state) {
  for (std::size_t t = 0; t < places.size(); ++t) topology.add_tube(elements);
  state = State(static_cast<std::size_t>(topology.elements()));
  std::size_t i = 0;
  for (const auto& [x, y] : places)
    for (int e = 0; e < elements; ++e) state.position.set(i++, {x, y, (e - 0.5 * (elements - 1)) * element_length});
}

}  // namespace ropewalk
