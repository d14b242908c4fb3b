// [statics] states of rest along the schedules of the loads.
#include "scene/tables/tables.hpp"

namespace ropewalk {

const KeyTable<StaticsOptions>& statics_table() {
  using Key = KeyOf<StaticsOptions>;
  static const KeyTable<StaticsOptions> table = {
      "statics",
      "for mode = \"relax\" with solver = \"newton\" or \"auto\": states of rest along the way of the loads",
      {Key::integer(
          "steps", 1, 100000, &StaticsOptions::steps, required("20"),
          "states of rest along the schedules of [twist] and grips, evenly in the time in which these change; "
          "each is a row of log.csv and of equilibria.csv")},
      {}};
  return table;
}

}  // namespace ropewalk
