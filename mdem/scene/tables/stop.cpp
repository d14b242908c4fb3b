// [[stop]] when a run ends before its time.
#include "scene/stop_rule.hpp"
#include "scene/tables/tables.hpp"

namespace ropewalk {
namespace {

using When = StopRule::When;

Words<When> occasions() {
  return {{"above", When::above},   {"below", When::below}, {"steady", When::steady},
          {"growth", When::growth}, {"limit", When::limit}, {"shape", When::shape}};
}

bool reads_a_column(const StopRule& rule) { return rule.when != When::limit && rule.when != When::shape; }

void read_column(const TomlTable& t, const Scene&, StopRule& rule) {
  if (!reads_a_column(rule)) {
    if (t.has("column"))
      throw t.error("column", "is not for when = \"limit\" and \"shape\"",
                    "write limit = \"wall_twist\" or shape = \"helix\"");
    return;
  }
  rule.column = t.string("column");
}

void read_value(const TomlTable& t, const Scene&, StopRule& rule) {
  if (!reads_a_column(rule) && !t.has("value")) return;
  const bool any = rule.when == When::above || rule.when == When::below;
  if (rule.when == When::limit) throw t.error("value", "is not for when = \"limit\"", "set the value in [limits]");
  if (rule.when == When::shape) throw t.error("value", "is not for when = \"shape\"", "take it away");
  rule.value = t.number("value", any ? Bounds::any() : Bounds::positive(1e12));
}

void read_limit(const TomlTable& t, const Scene&, StopRule& rule) {
  if (!t.has("limit")) return;
  if (rule.when != When::limit) throw t.error("limit", "is for when = \"limit\" alone", "take it away");
  Words<std::string> words;
  for (const LimitKind& kind : limit_kinds()) words.emplace_back(kind.key, kind.key);
  rule.limit = t.word("limit", words);
}

void read_shape(const TomlTable& t, const Scene&, StopRule& rule) {
  if (!t.has("shape")) {
    if (rule.when == When::shape) throw t.error("shape", "is missing", "write shape = \"helix\"");
    return;
  }
  if (rule.when != When::shape) throw t.error("shape", "is for when = \"shape\" alone", "take it away");
  Words<RopeShape> words;
  for (const RopeShape shape : rope_shapes) words.emplace_back(name_of(shape), shape);
  rule.shape = t.word("shape", words);
}

}  // namespace

const KeyTable<StopRule>& stop_table() {
  using Key = KeyOf<StopRule>;
  static const KeyTable<StopRule> table = {
      "stop",
      "any number of these: the run ends before its time where one of them comes true",
      {Key::word(
           "when", occasions(), &StopRule::when, required("\"above\""),
           "\"above\", \"below\": a column of the log passes a value; \"steady\": it changes by less than the "
           "value; \"growth\": the rate of its exponential growth is known to this relative error; \"limit\": a "
           "limit is passed; \"shape\": the rope has taken this shape"),
       Key::custom("column", "", otherwise("\"amplitude_nm\"", "required but for \"limit\" and \"shape\""),
                   "a column of log.csv", read_column),
       Key::custom("value", "", otherwise("1", "required but for \"limit\" and \"shape\""),
                   "in the unit of the column; growth: 0.05 is 5 %", read_value),
       Key::number("over_ps", unit::ps, Bounds::positive(longest_time), &StopRule::over, standard(),
                   "steady, growth: length of time over which the last rows are judged")
           .of_pace(SceneKey::Pace::time),
       Key::number("from_ps", unit::ps, Bounds::non_negative(longest_time), &StopRule::from, standard(),
                   "the rule is not looked at before this time")
           .of_pace(SceneKey::Pace::time),
       Key::custom("limit", "", otherwise("\"wall_twist\"", "any"), "limit: the key of [limits] that counts",
                   read_limit),
       Key::custom("shape", "", otherwise("\"helix\"", "required for \"shape\""),
                   "\"straight\", \"spindle\", \"helix\", \"brush\", \"cage\" or \"snarl\"", read_shape)},
      {},
      StopRule(),
      true};
  return table;
}

}  // namespace ropewalk
