#include "scene/kinds/rope.hpp"

#include <fmt/format.h>

#include <cmath>

#include "scene/bounds.hpp"
#include "scene/lattice.hpp"
#include "scene/scene.hpp"

namespace ropewalk {
namespace {

void check_rope(const TomlTable& t, const Scene& scene, RopeSource& rope) {
  const auto [below, above] = nearest_hexagonal(rope.tubes);
  if (below != above)
    throw t.error("tubes", fmt::format("is {}, not a hexagonal number", rope.tubes),
                  fmt::format("the nearest are {} and {}", below, above));
  const double elements = std::round(rope.length / scene.element_length);
  if (elements < 3)
    throw t.error("length_nm",
                  fmt::format("is {} nm, {} elements of {} nm", rope.length, elements, scene.element_length),
                  fmt::format("at least 3 elements, {:.4g} nm, are needed", 3 * scene.element_length));
  check_size(t, "length_nm", rope.tubes, elements);
}

void displace(double amplitude, Random& random, State& state) {
  for (std::size_t i = 0; i < state.size(); ++i) {
    state.position.x[i] += random.uniform(-amplitude, amplitude);
    state.position.y[i] += random.uniform(-amplitude, amplitude);
  }
}

}  // namespace

SceneKind rope_kind() {
  using Key = KeyOf<RopeSource>;
  return scene_kind<RopeSource>(
      {"rope",
       "parallel tubes along z in hexagonal packing, centred on the origin",
       {Key::integer("tubes", 1, max_elements, &RopeSource::tubes, required("91"),
                     "a hexagonal number: 1, 7, 19, 37, 61, 91, 127, 169, 217, ..."),
        Key::number("length_nm", unit::nm, Bounds::positive(1e9), &RopeSource::length, required("67.8"),
                    "length of the tubes, rounded to whole elements")
            .is_tube_size(SceneKey::TubeSize::length),
        Key::number("spacing_nm", unit::nm, spacing_bounds, &RopeSource::spacing,
                    otherwise("1.713", "where two tubes bind best"), "distance between tube axes"),
        Key::number("perturbation_nm", unit::nm, Bounds::non_negative(0.1), &RopeSource::perturbation, standard(),
                    "each element is displaced at random by up to this in x and y")},
       check_rope});
}

Source::Sizes RopeSource::sizes(double element_length) const {
  return {tubes, whole_elements(length, element_length)};
}

void RopeSource::place(const Scene& scene, double spacing_of_tubes, Random& random, Topology& topology,
                       State& state) const {
  add_straight_tubes(hexagonal_lattice(tubes, spacing_of_tubes), sizes(scene.element_length).elements,
                     scene.element_length, topology, state);
  if (perturbation > 0) displace(perturbation, random, state);
}

std::string RopeSource::description(const Topology& t, const State&, double spacing_of_tubes) const {
  return fmt::format("a rope of {:.4g} nm, spacing {:.4g} nm", t.length_of(0) * t.longest_element(),
                     spacing_of_tubes);
}

}  // namespace ropewalk
