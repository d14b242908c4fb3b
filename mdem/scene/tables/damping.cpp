// [damping] Dissipation belongs to a length of tube. Two rows have four times as many pairs in reach of the contact
// viscosity per length where elements are half as long, so that eta goes as the square of the element length; the
// viscosity of a bonded chain goes as the rate times that square, so that the rate goes as its inverse. PFC's local
// damping has no length.
#include "scene/dissipation.hpp"
#include "scene/tables/tables.hpp"

namespace ropewalk {
namespace {

Damping defaults() {
  Damping d;
  d.contact.eta = -1;  // not typed
  d.bond.rate = 1;
  return d;
}

}  // namespace

const KeyTable<Damping>& damping_table() {
  using Key = KeyOf<Damping>;
  static const KeyTable<Damping> table = {
      "damping",
      "numerical damping, which atoms do not have: it brings a scene to rest. Where the way there counts, set the "
      "contact "
      "viscosity to 0 and take [[friction]] from = \"atoms\"; 0 switches a term off",
      {Key::number(
           "contact_viscosity_eV_ps_per_nm2", {"eV ps/nm^2", 1}, Bounds::non_negative(1e6),
           [](auto& d) -> auto& { return d.contact.eta; },
           otherwise("20",
                     "27 eV ps/nm^3 per length of contact: 20 for elements of 1.356 nm of the published tube"),
           "against sliding at contact points")
           .goes_as_length(2),
       Key::number(
           "bond_damping_per_ps", {"1/ps", 1}, Bounds::non_negative(1e4),
           [](auto& d) -> auto& { return d.bond.rate; }, standard(), "against relative motion of bonded elements")
           .goes_as_length(-2),
       Key::number("pfc_local", unit::none, Bounds::range(0, 1), &Damping::local, standard(),
                   "PFC3D's local damping, 0 to 1; breaks momentum conservation")},
      [](const TomlTable&, const Scene& scene, Damping& d) {
        if (d.contact.eta < 0)
          d.contact.eta = default_contact_viscosity(scene.element_length, scene.parameters().radius);
      },
      defaults()};
  return table;
}

}  // namespace ropewalk
