// [limits] what the run watches, in the order of limit_kinds().
#include "scene/tables/tables.hpp"

namespace ropewalk {
namespace {

struct Text {
  Presence presence;
  const char* meaning;
};

const std::array<Text, limit_count>& texts() {
  static const std::array<Text, limit_count> all = {{
      {standard("19.9"), "bend of one bond: its energy is then 1 % off the rod's"},
      {standard("19.9"), "twist of one bond: its energy is then 1 % off the rod's; at 90 it slips"},
      {otherwise("0.086", "the set's"), "curvature of a tube"},
      {otherwise("0.043", "the set's, for tubes of this length"), "radius of a tube times its twist per length"},
      {otherwise("0.069",
                 "in tension the last strain of [bond.pull] of the set, else validity.stretch; in compression "
                 "validity.stretch"),
       "strain of a bond, in tension or compression"},
      {otherwise("0.11", "down to the core gap of the law"),
       "how far tubes are pressed together beyond their distance at rest"},
      {otherwise("2", "a tenth of the speed of sound along the tube"), "speed of an element"},
      {otherwise("2.3", "where a tube of this diameter collapses"), "pressure of the contacts on a tube"},
      {standard("0.05"), "error of the energy balance over the energy that was converted"},
      {standard("0.25"),
       "kinetic energy of a cold rope, divided by the energy of twist that it has in the end, under the whole "
       "moment"},
  }};
  return all;
}

// Largest values of any sense: a bond slips at 90 degrees.
std::vector<KeyOf<LimitOptions>> keys() {
  std::vector<KeyOf<LimitOptions>> out;
  for (std::size_t k = 0; k < limit_count; ++k) {
    const LimitKind& kind = limit_kinds()[k];
    const double most = kind.unit_size == units::degree ? 90 : 1e3;
    out.push_back(
        KeyOf<LimitOptions>::custom(kind.key, kind.unit, texts()[k].presence, texts()[k].meaning,
                                    [k, most, &kind](const TomlTable& t, const Scene&, LimitOptions& limits) {
                                      if (t.has(kind.key))
                                        limits[k] = t.number(kind.key, Bounds::non_negative(most)) * kind.unit_size;
                                    }));
  }
  return out;
}

}  // namespace

const KeyTable<LimitOptions>& limits_table() {
  static const KeyTable<LimitOptions> table = {
      "limits", "limits of the model: the run says at once when it passes one of them; 0: not watched", keys(), {}};
  return table;
}

}  // namespace ropewalk
