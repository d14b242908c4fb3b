// [[expect]] what a run should give.
#include <cmath>

#include "scene/expectation.hpp"
#include "scene/tables/tables.hpp"

namespace ropewalk {
namespace {

void read_at(const TomlTable& t, const Scene&, Expectation& expected) {
  if (t.has("at_ps")) expected.at = t.number("at_ps", Bounds::non_negative(longest_time));
}

void read_tolerance(const TomlTable& t, const Scene&, Expectation& expected) {
  if (t.has("tolerance_percent") == t.has("tolerance"))
    throw t.error("tolerance", t.has("tolerance") ? "and tolerance_percent are both given" : "is missing",
                  "give one: tolerance, in the unit of the column, or tolerance_percent, of the value");
  if (t.has("tolerance")) {
    expected.tolerance = t.number("tolerance", Bounds::positive(1e12));
    return;
  }
  expected.tolerance = 0.01 * t.number("tolerance_percent", Bounds::positive(1e4)) * std::fabs(expected.value);
  if (expected.tolerance == 0)
    throw t.error("tolerance_percent", "is a part of the value, and that is 0", "give tolerance");
}

}  // namespace

const KeyTable<Expectation>& expect_table() {
  using Key = KeyOf<Expectation>;
  static const KeyTable<Expectation> table = {
      "expect",
      "any number of these: what the run should give; a run that misses one ends with exit code 8",
      {Key::custom("column", "", required("\"geometric_twist_deg\""), "a column of log.csv",
                   [](const TomlTable& t, const Scene&, Expectation& e) { e.column = t.string("column"); }),
       Key::custom("at_ps", "ps", otherwise("100", "the end of the run"),
                   "time at which the value is judged; between two rows it follows the line through both", read_at)
           .of_pace(SceneKey::Pace::time),
       Key::custom(
           "value", "", required("162.4"), "in the unit of the column",
           [](const TomlTable& t, const Scene&, Expectation& e) { e.value = t.number("value", Bounds::any()); }),
       Key::custom("tolerance", "", otherwise("0.5", "tolerance_percent"),
                   "the value may be off by so much, in the unit of the column", read_tolerance),
       Key::custom("tolerance_percent", "%", otherwise("1", "tolerance"), "the same, in per cent of the value",
                   [](const TomlTable&, const Scene&, Expectation&) {}),
       Key::custom(
           "scene_hash", "", otherwise("\"0123456789abcdef\"", "any"),
           "hash of the scene for which it holds, as `check` prints it; a changed scene is not judged by it",
           [](const TomlTable& t, const Scene&, Expectation& e) {
             if (t.has("scene_hash")) e.scene_hash = t.string("scene_hash");
           })},
      {},
      Expectation(),
      true};
  return table;
}

}  // namespace ropewalk
