// [bond] the energy of a bond.
#include <algorithm>

#include "scene/tables/tables.hpp"

namespace ropewalk {
namespace {

void read_bond_law(const TomlTable& t, const Scene& scene, BondOptions& bond) {
  const auto has = [](const ParameterSet& set) { return set.anharmonic.has_value(); };
  const bool all = std::all_of(scene.sets.begin(), scene.sets.end(), has);
  bond.anharmonic = t.word_or<bool>("law", all, {{"harmonic", false}, {"anharmonic", true}});
  if (!bond.anharmonic) return;
  for (const ParameterSet& set : scene.sets)
    if (!has(set))
      throw t.error("law", "is \"anharmonic\", and the set " + set.name + " has no [bond.anharmonic]",
                    "take law = \"harmonic\", or calibrate the set anew");
}

}  // namespace

const KeyTable<BondOptions>& bond_table() {
  using Key = KeyOf<BondOptions>;
  static const KeyTable<BondOptions> table = {
      "bond",
      "elastic bonds between elements",
      {Key::custom("law", "", otherwise("\"harmonic\"", "\"anharmonic\" where the set has it"),
                   "\"anharmonic\": as soft as the atoms up to the set's limits; \"harmonic\": Hooke's law",
                   read_bond_law)},
      {}};
  return table;
}

}  // namespace ropewalk
