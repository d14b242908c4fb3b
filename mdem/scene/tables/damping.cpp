// [damping] Dissipation belongs to a length of tube. Two rows have four times as many pairs in reach of the contact
// viscosity per length where elements are half as long, so that the viscosity of a pair goes as the square of the
// element length; the viscosity of a bonded chain goes as the rate times that square, so that the rate goes as its
// inverse. PFC's local damping has no length.
#include <fmt/format.h>

#include <algorithm>

#include "scene/dissipation.hpp"
#include "scene/tables/tables.hpp"

namespace ropewalk {
namespace {

constexpr const char* per_pair =
    "contact_viscosity_eV_ps_per_nm2";  // an old key, for elements of the set's own length
constexpr const char* per_length = "contact_viscosity_eV_ps_per_nm3";
Bounds viscosities() { return Bounds::non_negative(1e6); }

Damping defaults() {
  Damping d;
  d.contact.eta = default_viscosity;  // per length, until the table is complete
  d.bond.rate = 1;
  return d;
}

void complete(const TomlTable& t, const Scene& scene, Damping& d) {
  // Means over the sets, in whatever order the scene lists them.
  const auto count = static_cast<double>(scene.sets.size());
  double squared = 0, rate = 0;
  for (const ParameterSet& set : scene.sets) {
    const double longer = scene.element_length / set.element_length;
    squared += longer * longer / count;
    rate += d.bond.rate / (longer * longer) / count;
  }
  // t.has() would propose this key, which is that of earlier versions, for a misspelt one.
  const bool typed_per_pair = std::binary_search(t.keys().begin(), t.keys().end(), per_pair);
  if (typed_per_pair && t.has(per_length))
    throw t.error(per_pair, fmt::format("and {} are both given", per_length), "take this one away");
  d.contact.eta = typed_per_pair ? squared * t.number(per_pair, viscosities())
                                 : contact_viscosity(d.contact.eta, scene.element_length, scene.sets);
  d.bond.rate = rate;
}

}  // namespace

const KeyTable<Damping>& damping_table() {
  using Key = KeyOf<Damping>;
  static const KeyTable<Damping> table = {
      "damping",
      "numerical damping, which atoms do not have: it brings a scene to rest. Where the path counts and not only "
      "the final state, set the contact viscosity to 0 and take [[friction]] from = \"atoms\"; 0 switches a term "
      "off",
      {Key::number(
           per_length, {"eV ps/nm^3", 1}, viscosities(), [](auto& d) -> auto& { return d.contact.eta; }, standard(),
           "against sliding: force per length of contact and speed, between two tubes side by side"),
       Key::number(
           "bond_damping_per_ps", {"1/ps", 1}, Bounds::non_negative(1e4),
           [](auto& d) -> auto& { return d.bond.rate; }, standard(),
           "damps relative motion of bonded elements of the set's own length; elements of other lengths have the "
           "same viscosity per length"),
       Key::number("pfc_local", unit::none, Bounds::range(0, 1), &Damping::local, standard(),
                   "PFC3D's local damping, 0 to 1; breaks momentum conservation")},
      complete,
      defaults()};
  return table;
}

}  // namespace ropewalk
