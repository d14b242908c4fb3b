// [chain] one straight tube along z.
#include <algorithm>
#include <cmath>

#include "scene/kinds/scene_kind.hpp"
#include "scene/scene.hpp"

namespace ropewalk {
namespace {

class ChainSource : public Source {
 public:
  double length = 0;  // nm: elements may be made longer or shorter afterwards

  Sizes sizes(double element_length) const override {
    return {1, std::max(2, static_cast<int>(std::lround(length / element_length)))};
  }
  void place(const Scene& scene, double, Random&, Topology& topology, State& state) const override {
    add_straight_tubes({{0.0, 0.0}}, sizes(scene.element_length).elements, scene.element_length, topology, state);
  }
  bool is_parallel() const override { return true; }
};

void read_chain_elements(const TomlTable& t, const Scene& scene, ChainSource& chain) {
  const auto elements = static_cast<double>(t.integer("elements", 2, 1000000000));
  check_size(t, "elements", 1, elements);
  chain.length = elements * scene.element_length;
}

}  // namespace

SceneKind chain_kind() {
  using Key = KeyOf<ChainSource>;
  return scene_kind<ChainSource>(
      {"chain",
       "instead of [rope]: one straight tube along z",
       {Key::custom("elements", "", required("41"), "number of elements, 2 or more", read_chain_elements)
            .is_tube_size(SceneKey::TubeSize::elements)},
       {}});
}

}  // namespace ropewalk
