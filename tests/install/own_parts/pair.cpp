// A scene kind of one's own beside the installed library: [pair], two tubes side by side at a distance. How such a file
// is written: docs/how-to/scene-kind.md.
#include "scene/kinds/scene_kind.hpp"
#include "scene/lattice.hpp"
#include "scene/scene.hpp"
#include "scene/spacing.hpp"

namespace ropewalk {
namespace {

class PairSource : public Source {
 public:
  double length = 0, apart = 0;  // nm

  Sizes sizes(double element_length) const override { return {2, whole_elements(length, element_length)}; }
  void place(const Scene& scene, double, Random&, Topology& topology, State& state) const override {
    add_straight_tubes({{-0.5 * apart, 0}, {0.5 * apart, 0}}, sizes(scene.element_length).elements, scene.element_length,
                       topology, state);
  }
  bool is_parallel() const override { return true; }
};

SceneKind pair_kind() {
  using Key = KeyOf<PairSource>;
  return scene_kind<PairSource>(
      {"pair",
       "instead of [rope]: two tubes side by side",
       {Key::number("length_nm", unit::nm, Bounds::positive(1e6), &PairSource::length, required("20"),
                    "length of the tubes, rounded to whole elements")
            .is_tube_size(SceneKey::TubeSize::length),
        Key::number("apart_nm", unit::nm, spacing_bounds, &PairSource::apart, required("1.7"), "distance of the axes")},
       {}});
}

const bool added = add_scene_kind(pair_kind());

}  // namespace
}  // namespace ropewalk
