#include "observe/observables.hpp"

#include <algorithm>
#include <cctype>
#include <stdexcept>

#include "model/units.hpp"

namespace ropewalk {
namespace {

using Group = ObservableGroup;
using M = Measurement;
using units::degree;

double balance(const M& m) {
  const EnergyAccount& a = m.account;
  return a.potential.potential() + a.kinetic - a.work + a.dissipated - a.heat - a.first_energy;
}

std::vector<Observable>& table() {
  constexpr bool whole = true;
  static std::vector<Observable> entries = {
      {"step", "", "time step", Group::time, [](const M& m) { return static_cast<double>(m.state.step); }, whole},
      {"time_ps", "ps", "time", Group::time, [](const M& m) { return m.state.time; }},

      {"moment_nN_nm", "nN nm", "moment of the twist protocol: per tube or in total, as the scene gives it",
       Group::load, [](const M& m) { return m.account.moment / units::nN_nm; }},

      {"stretch_eV", "eV", "stretch energy of the bonds", Group::energy,
       [](const M& m) { return m.account.potential.stretch; }},
      {"shear_eV", "eV", "shear energy of the bonds", Group::energy,
       [](const M& m) { return m.account.potential.shear; }},
      {"bend_eV", "eV", "bending energy of the bonds", Group::energy,
       [](const M& m) { return m.account.potential.bend; }},
      {"twist_eV", "eV", "torsional energy of the bonds", Group::energy,
       [](const M& m) { return m.account.potential.twist; }},
      {"vdw_eV", "eV", "van der Waals energy of the contacts", Group::energy,
       [](const M& m) { return m.account.potential.vdw; }},
      {"kinetic_eV", "eV", "kinetic energy of translation and rotation", Group::energy,
       [](const M& m) { return m.account.kinetic; }},
      {"work_eV", "eV", "work done by the loads since the start", Group::energy,
       [](const M& m) { return m.account.work; }},
      {"dissipated_eV", "eV", "energy taken out by damping since the start", Group::energy,
       [](const M& m) { return m.account.dissipated; }},
      {"thermostat_eV", "eV", "heat that the thermostat has brought in since the start", Group::energy,
       [](const M& m) { return m.account.heat; }},
      {"balance_eV", "eV",
       "total energy - work + dissipated energy - heat, less its first value: the error of integration",
       Group::energy, balance},

      {"beta_deg", "deg", "mean angle of the outermost tubes to the rope axis, over the middle third", Group::twist,
       [](const M& m) { return m.rope.beta / degree; }},
      {"physical_twist_deg", "deg", "twist of the bonds of a tube, end to end, mean over the tubes", Group::twist,
       [](const M& m) { return m.rope.physical_twist / degree; }},
      {"geometric_twist_deg", "deg", "rotation of the tubes about the centre line of the rope, end to end",
       Group::twist, [](const M& m) { return m.rope.geometric_twist / degree; }},

      {"Q", "", "packing charge of the middle section, neighbours by distance", Group::packing,
       [](const M& m) { return static_cast<double>(m.rope.middle.charge); }, whole},
      {"Q_delaunay", "", "packing charge of the middle section, neighbours by Delaunay triangulation",
       Group::packing, [](const M& m) { return static_cast<double>(m.rope.middle.charge_delaunay); }, whole},
      {"contacts", "", "pairs of neighbours in the middle section, by distance", Group::packing,
       [](const M& m) { return static_cast<double>(m.rope.middle.contacts); }, whole},
      {"voids", "", "voids in the middle section", Group::packing,
       [](const M& m) { return static_cast<double>(m.rope.middle.voids); }, whole},
      {"void_area_nm2", "nm^2", "area of the voids in the middle section", Group::packing,
       [](const M& m) { return m.rope.middle.void_area; }},

      {"radius_mid_nm", "nm", "outer radius of the rope at its middle", Group::shape,
       [](const M& m) { return m.rope.radius_mid; }},
      {"radius_end_nm", "nm", "outer radius of the rope at its ends, mean of both", Group::shape,
       [](const M& m) { return m.rope.radius_end; }},
      {"length_nm", "nm", "arc length of the centre line", Group::shape, [](const M& m) { return m.rope.length; }},
      {"amplitude_nm", "nm", "largest distance of the centre line from its chord", Group::shape,
       [](const M& m) { return m.rope.amplitude; }},
      {"windings", "", "turns of the centre line about its chord", Group::shape,
       [](const M& m) { return m.rope.windings; }},

      {"kinked", "", "bonds beyond the kink curvature of the parameter set", Group::limits,
       [](const M& m) { return static_cast<double>(m.rope.kinked); }, whole},
      {"overtwisted", "", "bonds beyond the twist limit of the parameter set", Group::limits,
       [](const M& m) { return static_cast<double>(m.rope.overtwisted); }, whole},
      {"overstretched", "", "bonds beyond the strain limit of the parameter set", Group::limits,
       [](const M& m) { return static_cast<double>(m.rope.overstretched); }, whole},
      {"largest_bond_twist_deg", "deg", "largest twist of one bond, absolute", Group::limits,
       [](const M& m) { return m.rope.largest_bond_twist / degree; }},
  };
  return entries;
}

bool is_taken(std::string_view name) {
  return std::any_of(table().begin(), table().end(), [&](const Observable& o) { return o.name == name; });
}

bool is_word(const std::string& name) {
  return !name.empty() &&
         std::all_of(name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) || c == '_'; });
}

// The ending of a name that stands for a unit: "nN nm" gives _nN_nm, "nm^2" gives _nm2, "1/ps" gives _per_ps.
std::string suffix_of(const std::string& unit) {
  std::string suffix;
  for (const char c : unit) suffix += c == '^' ? "" : c == ' ' ? "_" : c == '/' ? "_per_" : std::string(1, c);
  if (suffix.compare(0, 6, "1_per_") == 0) return suffix.substr(1);
  return suffix.empty() ? "" : "_" + suffix;
}

bool ends_in(const std::string& name, const std::string& suffix) {
  return name.size() > suffix.size() && name.compare(name.size() - suffix.size(), suffix.size(), suffix) == 0;
}

}  // namespace

const char* group_title(ObservableGroup group) {
  switch (group) {
    case Group::time:
      return "Time";
    case Group::load:
      return "Load";
    case Group::energy:
      return "Energy";
    case Group::twist:
      return "Twist";
    case Group::packing:
      return "Packing";
    case Group::shape:
      return "Shape";
    case Group::limits:
      return "Limits of the model";
  }
  return "";
}

bool in_frames(ObservableGroup group) { return group != Group::load && group != Group::energy; }

const std::vector<Observable>& observables() { return table(); }

void add_observable(const Observable& o) {
  if (is_taken(o.name)) throw std::invalid_argument("an observable is called " + o.name + " already");
  if (!is_word(o.name)) throw std::invalid_argument("name of an observable: letters, digits and _ only: " + o.name);
  if (!ends_in(o.name, suffix_of(o.unit)))
    throw std::invalid_argument("name of an observable does not end in its unit: " + o.name);
  if (!o.value) throw std::invalid_argument("an observable has no value: " + o.name);
  table().push_back(o);
}

std::size_t index_of_observable(std::string_view name) {
  const std::vector<Observable>& all = observables();
  const auto found = std::find_if(all.begin(), all.end(), [&](const Observable& o) { return o.name == name; });
  if (found == all.end()) throw std::invalid_argument("no observable is called " + std::string(name));
  return static_cast<std::size_t>(found - all.begin());
}

std::string observables_markdown() {
  std::string text = "| name | unit | meaning | group | in frames |\n|---|---|---|---|---|\n";
  for (const Observable& o : observables())
    text += "| `" + o.name + "` | " + o.unit + " | " + o.meaning + " | " + group_title(o.group) + " | " +
            (in_frames(o.group) ? "yes" : "no") + " |\n";
  return text;
}

}  // namespace ropewalk
