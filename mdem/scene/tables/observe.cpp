// [observe] what to measure.
#include "scene/spacing.hpp"
#include "scene/tables/tables.hpp"

namespace ropewalk {

const KeyTable<ObserveOptions>& observe_table() {
  using Key = KeyOf<ObserveOptions>;
  static const KeyTable<ObserveOptions> table = {
      "observe",
      "what to measure",
      {Key::number(
          "neighbour_radius_nm", unit::nm,
          [](const Scene& scene) {
            const double diameter = 2 * largest_radius(scene);
            return Bounds{diameter, 20 * diameter, true};
          },
          &ObserveOptions::neighbour_radius, otherwise("2.34", "between first and second shell"),
          "tubes closer than this are neighbours")},
      {}};
  return table;
}

}  // namespace ropewalk
