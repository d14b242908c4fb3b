#include "chart/own_kinds.hpp"

#include <Eigen/Geometry>
#include <cmath>

#include "cases/common/chain.hpp"
#include "scene/kinds/scene_kind.hpp"
#include "scene/scene.hpp"

namespace ropewalk::validate {
namespace {

class BetweenCentres : public Source {
 public:
  double length = 0;  // nm
  int bonds(double element_length) const { return static_cast<int>(std::lround(length / element_length)); }
};

// One tube along x, the other at an angle to it; the crossing on the axis z.
class Crossing : public BetweenCentres {
 public:
  double angle = 0, distance = 0;  // rad, nm

  Sizes sizes(double element_length) const override { return {2, bonds(element_length) + 1}; }
  void place(const Scene& scene, double, Random&, Topology& topology, State& state) const override {
    const int n = bonds(scene.element_length);
    state = State(static_cast<std::size_t>(2 * (n + 1)));
    for (const int tube : {0, 1}) {
      const Vector3 along(std::cos(tube * angle), std::sin(tube * angle), 0);
      const int first = topology.elements();
      topology.add_tube(n + 1);
      for (int e = 0; e <= n; ++e) {
        const auto i = static_cast<std::size_t>(first + e);
        state.position.set(i, (e - 0.5 * n) * scene.element_length * along + Vector3(0, 0, tube * distance));
        state.orientation.set(i, Quaternion::FromTwoVectors(Vector3::UnitZ(), along));
      }
    }
  }
};

// Round the line y through (R, 0, 0), from the origin along z and back to it.
class Ring : public BetweenCentres {
 public:
  Sizes sizes(double element_length) const override { return {1, bonds(element_length) + 1}; }
  void place(const Scene& scene, double, Random&, Topology& topology, State& state) const override {
    const int n = bonds(scene.element_length);
    const double step = 2 * units::pi / n, radius = 0.5 * scene.element_length / std::sin(0.5 * step);
    topology.add_tube(n + 1);
    state = State(static_cast<std::size_t>(n + 1));
    for (int e = 0; e <= n; ++e) {
      const auto i = static_cast<std::size_t>(e);
      state.position.set(i, {radius * (1 - std::cos(e * step)), 0, radius * std::sin(e * step)});
      state.orientation.set(i, turn_about(Vector3::UnitY(), e * step));
    }
  }
};

template <class S>
KeyOf<S> length_key() {
  return KeyOf<S>::number("length_nm", unit::nm, Bounds::positive(1e6), &S::length, required("10.848"),
                          "from the centre of the first element to that of the last");
}

}  // namespace

void add_own_kinds() {
  static const bool added = [] {
    using Key = KeyOf<Crossing>;
    return add_scene_kind(
               scene_kind<Crossing>({"crossing",
                                     "two tubes that cross in their middles",
                                     {length_key<Crossing>(),
                                      Key::number("angle_deg", unit::degree, Bounds::range(0, 90), &Crossing::angle,
                                                  required("90"), "between the tubes"),
                                      Key::number("distance_nm", unit::nm, Bounds::positive(1e3),
                                                  &Crossing::distance, required("1.7"), "of their axes")},
                                     {}})) &&
           add_scene_kind(scene_kind<Ring>(
               {"ring", "a tube bent into a circle, its ends in one place", {length_key<Ring>()}, {}}));
  }();
  (void)added;
}

}  // namespace ropewalk::validate
