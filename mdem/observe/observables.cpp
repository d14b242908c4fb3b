#include "observe/observables.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "model/units.hpp"
#include "sim/forces/force_term.hpp"

namespace ropewalk {
namespace {

using Group = ObservableGroup;
using M = Measurement;
using units::degree;

constexpr double rounding = 1e-4;  // relative to the potential energies: pairs are in single precision

// Energies of what is measured: of one period of a slice, else of all.
const Energies& energies(const M& m) {
  return m.account.period ? m.account.period->potential : m.account.potential;
}
const Energies& first_energies(const M& m) { return m.account.period ? m.account.period->first : m.account.first; }
// MJ/kg, which is 1 eV over 1 eV ps^2/nm^2.
double stored(const M& m, double Energies::*part) {
  return (energies(m).*part - first_energies(m).*part) / m.size.mass;
}
double stored(const M& m) { return (energies(m).potential() - first_energies(m).potential()) / m.size.mass; }

// eV/nm, mean of both ends.
double end_tension(const M& m) {
  return 0.5 * (m.account.ends[upper_end].force.z() - m.account.ends[lower_end].force.z());
}
double torque(const M& m, End end, Eigen::Index axis) { return m.account.ends[end].torque[axis] / units::nN_nm; }

// A count in the middle section; nan for tubes without a common centre line, which have no such section.
double in_section(const M& m, int count) {
  return m.topology.tubes() > 0 && m.rope.centre_line.empty() ? std::numeric_limits<double>::quiet_NaN() : count;
}

std::vector<Observable>& table() {
  constexpr bool whole = true, real = false;
  static std::vector<Observable> entries = {
      {"step", "", "time step", Group::time, [](const M& m) { return static_cast<double>(m.state.step); }, whole,
       "time steps"},
      {"time_ps", "ps", "time", Group::time, [](const M& m) { return m.state.time; }},

      {"time_step_fs", "fs", "time step, a part of the whole one where the motion is fast", Group::load,
       [](const M& m) { return m.account.time_step / units::fs; }},
      {"moment_nN_nm", "nN nm",
       "moment about the axis that is prescribed at the ends, on each tube or in total as the scene has it; "
       "left-handed: negative",
       Group::load, [](const M& m) { return m.account.moment / units::nN_nm; }},

      {"torque_upper_nN_nm", "nN nm",
       "torque about z on the upper end, mean since the row before; positive: it twists the rope to the right",
       Group::load, [](const M& m) { return torque(m, upper_end, 2); }, real, "torque, upper end"},
      {"torque_lower_nN_nm", "nN nm",
       "torque about z on the lower end, mean since the row before; negative: it twists the rope to the right",
       Group::load, [](const M& m) { return -torque(m, lower_end, 2); }, real, "torque, lower end"},
      {"torque_upper_x_nN_nm", "nN nm", "torque about x on the upper end, about its centre", Group::load,
       [](const M& m) { return torque(m, upper_end, 0); }, real, "torque about x, upper end"},
      {"torque_upper_y_nN_nm", "nN nm", "the same about y", Group::load,
       [](const M& m) { return torque(m, upper_end, 1); }, real, "torque about y, upper end"},
      {"torque_lower_x_nN_nm", "nN nm", "torque about x on the lower end, about its centre", Group::load,
       [](const M& m) { return torque(m, lower_end, 0); }, real, "torque about x, lower end"},
      {"torque_lower_y_nN_nm", "nN nm", "the same about y", Group::load,
       [](const M& m) { return torque(m, lower_end, 1); }, real, "torque about y, lower end"},
      {"tension_upper_nN", "nN", "force along z on the upper end, mean since the row before; positive: it pulls",
       Group::load, [](const M& m) { return m.account.ends[upper_end].force.z() / units::nN_nm; }, real,
       "tension, upper end"},
      {"tension_lower_nN", "nN", "force along z on the lower end, mean since the row before; negative: it pulls",
       Group::load, [](const M& m) { return -m.account.ends[lower_end].force.z() / units::nN_nm; }, real,
       "tension, lower end"},
      {"rotation_deg", "deg", "rotation of the upper end against the lower one about z, whole turns included",
       Group::load,
       [](const M& m) { return (m.account.ends[upper_end].turned - m.account.ends[lower_end].turned) / degree; }},
      {"work_upper_eV", "eV", "work done on the upper end since the start", Group::load,
       [](const M& m) { return m.account.ends[upper_end].work; }, real, "work on the upper end"},
      {"work_lower_eV", "eV", "work done on the lower end since the start", Group::load,
       [](const M& m) { return m.account.ends[lower_end].work; }, real, "work on the lower end"},

      {"stretch_eV", "eV", "stretch energy of the bonds", Group::energy,
       [](const M& m) { return m.account.potential.stretch; }, real, "stretch energy"},
      {"shear_eV", "eV", "shear energy of the bonds", Group::energy,
       [](const M& m) { return m.account.potential.shear; }, real, "shear energy"},
      {"bend_eV", "eV", "bending energy of the bonds", Group::energy,
       [](const M& m) { return m.account.potential.bend; }, real, "bending energy"},
      {"twist_eV", "eV", "torsional energy of the bonds", Group::energy,
       [](const M& m) { return m.account.potential.twist; }, real, "twist energy"},
      {"vdw_eV", "eV", "van der Waals energy of the contacts", Group::energy,
       [](const M& m) { return m.account.potential.vdw; }, real, "van der Waals energy"},
      {"kinetic_eV", "eV", "kinetic energy of translation and rotation", Group::energy,
       [](const M& m) { return m.account.kinetic; }, real, "kinetic energy"},
      {"work_eV", "eV", "work done by the loads since the start", Group::energy,
       [](const M& m) { return m.account.work; }, real, "work of the loads"},
      {"dissipated_eV", "eV", "energy lost since the start, to damping and to friction", Group::energy,
       [](const M& m) { return m.account.dissipated; }, real, "dissipated energy"},
      {"damping_eV", "eV", "the part of it that numerical damping has taken, which atoms do not have",
       Group::energy, [](const M& m) { return lost_to_damping(m.account); }, real, "energy lost to damping"},
      {"thermostat_eV", "eV", "heat that the thermostat has brought in since the start", Group::energy,
       [](const M& m) { return m.account.heat; }, real, "heat of the thermostat"},
      {"balance_eV", "eV",
       "total energy - work + dissipated energy - heat, less its first value: the error of integration",
       Group::energy, [](const M& m) { return energy_balance(m.account); }, real, "energy balance"},

      {"stored_MJ_per_kg", "MJ/kg",
       "potential energy since the start over the mass of the tubes; of a slice: of one period", Group::energy,
       [](const M& m) { return stored(m); }, real, "stored energy"},
      {"stored_stretch_MJ_per_kg", "MJ/kg", "the share of stretch and shear", Group::energy,
       [](const M& m) { return stored(m, &Energies::stretch) + stored(m, &Energies::shear); }, real,
       "energy stored by stretch"},
      {"stored_bend_MJ_per_kg", "MJ/kg", "the share of bending", Group::energy,
       [](const M& m) { return stored(m, &Energies::bend); }, real, "energy stored by bending"},
      {"stored_twist_MJ_per_kg", "MJ/kg", "the share of torsion", Group::energy,
       [](const M& m) { return stored(m, &Energies::twist); }, real, "energy stored by twist"},
      {"stored_contact_MJ_per_kg", "MJ/kg", "the share of the contacts", Group::energy,
       [](const M& m) { return stored(m, &Energies::vdw); }, real, "energy stored by contacts"},
      {"cohesion_lost", "", "part of the van der Waals energy of the start that is lost", Group::energy,
       [](const M& m) {
         const double first = first_energies(m).vdw;
         return first < 0 ? (energies(m).vdw - first) / -first : 0.0;
       }},

      {"ends_apart_nm", "nm", "distance between the centres of both ends; of a periodic slice: its period",
       Group::shape, [](const M& m) { return m.loading.ends_apart; }, real, "distance of the ends"},
      {"ends_strain", "", "the change of that distance since the start, over the free length between the ends",
       Group::shape, [](const M& m) { return m.loading.strain; }, real, "strain of the rope"},
      {"least_tension_nN", "nN", "smallest tension of a tube, averaged over its middle third", Group::tubes,
       [](const M& m) { return m.loading.least_tension / units::nN_nm; }, real, "least tension of a tube"},
      {"most_tension_nN", "nN", "largest tension of a tube, averaged over its middle third", Group::tubes,
       [](const M& m) { return m.loading.most_tension / units::nN_nm; }, real, "largest tension of a tube"},
      {"most_curvature_per_nm", "1/nm", "largest curvature of a tube", Group::tubes,
       [](const M& m) { return m.loading.curvature; }, real, "largest curvature of a tube"},
      {"slip_nm", "nm", "largest displacement of a tube along a neighbour since the start", Group::tubes,
       [](const M& m) { return m.loading.slip; }, real, "largest slip"},
      {
          "core_pressure_GPa", "GPa",
          "pressure of the contacts on the innermost tube; none where no tube is internal", Group::tubes,
          [](const M& m) { return m.loading.core_pressure / units::nN_nm; }, real,
          "pressure in the core"  // 1 GPa is 1 nN/nm^2
      },

      {"beta_deg", "deg", "mean angle of the outermost tubes to the axis of their rope, over the middle third",
       Group::twist, [](const M& m) { return m.rope.beta / degree; }, real, "twist angle β"},
      {"physical_twist_deg", "deg", "twist of the bonds of a tube against the natural one, end to end, mean over the tubes", Group::twist,
       [](const M& m) { return m.rope.physical_twist / degree; }},
      {"geometric_twist_deg", "deg", "rotation of the tubes about the centre line of the rope, end to end",
       Group::twist, [](const M& m) { return m.rope.geometric_twist / degree; }},
      {"ply_angle_deg", "deg",
       "angle at which plied ropes wind round the axis of them all, middle third; right-handed: positive; nan: one "
       "rope",
       Group::twist, [](const M& m) { return m.rope.ply_angle / degree; }},

      {"Q", "", "packing charge of the middle section, neighbours by distance", Group::packing,
       [](const M& m) { return in_section(m, m.rope.middle.charge); }, whole, "packing charge Q"},
      {"Q_delaunay", "", "packing charge of the middle section, neighbours by Delaunay triangulation",
       Group::packing, [](const M& m) { return in_section(m, m.rope.middle.charge_delaunay); }, whole,
       "packing charge Q, Delaunay"},
      {"contacts", "", "pairs of neighbours in the middle section, by distance", Group::packing,
       [](const M& m) { return in_section(m, m.rope.middle.contacts); }, whole, "contacts in the section"},
      {"voids", "", "voids in the middle section", Group::packing,
       [](const M& m) { return in_section(m, m.rope.middle.voids); }, whole, "voids in the section"},
      {"void_area_nm2", "nm^2", "area of the voids in the middle section", Group::packing,
       [](const M& m) { return m.rope.middle.void_area; }, real, "area of voids"},

      {"radius_mid_nm", "nm", "outer radius of the rope at its middle", Group::shape,
       [](const M& m) { return m.rope.radius_mid; }, real, "radius at the middle"},
      {"radius_end_nm", "nm", "outer radius of the rope at its ends, mean of both", Group::shape,
       [](const M& m) { return m.rope.radius_end; }, real, "radius at the ends"},
      {"length_nm", "nm", "arc length of the centre line", Group::shape, [](const M& m) { return m.rope.length; },
       real, "length of the centre line"},
      {"amplitude_nm", "nm", "largest distance of the centre line from its chord", Group::shape,
       [](const M& m) { return m.rope.amplitude; }, real, "amplitude of the centre line"},
      {"windings", "", "turns of the centre line about its chord", Group::shape,
       [](const M& m) { return m.rope.windings; }, real, "windings of the centre line"},
      {"helix_radius_nm", "nm",
       "root mean square distance of the centre line from the axis of its helix; nan: amplitude below one spacing",
       Group::shape, [](const M& m) { return m.rope.helix_radius; }, real, "radius of the helix"},
      {"pitch_nm", "nm", "length along the axis of the helix for one of its turns; nan: less than half a turn",
       Group::shape, [](const M& m) { return m.rope.pitch; }, real, "pitch of the helix"},
      {"middle_amplitude_nm", "nm", "largest distance of the middle 80 % of the centre line from its own chord",
       Group::shape, [](const M& m) { return m.rope.middle_amplitude; }, real, "amplitude of the middle 80 %"},
      {"writhe", "", "writhe of the centre line, in turns; right-handed: positive", Group::shape,
       [](const M& m) { return m.rope.writhe; }, real, "writhe of the centre line"},
      {"turned_back", "", "part of the centre line that runs against its chord, as some of every loop does",
       Group::shape, [](const M& m) { return m.rope.turned_back; }, real, "part that runs back"},

      {"kinked", "", "bonds beyond the kink curvature of the parameter set", Group::limits,
       [](const M& m) { return static_cast<double>(m.rope.kinked); }, whole, "kinked bonds"},
      {"overtwisted", "", "bonds beyond the twist limit of the parameter set", Group::limits,
       [](const M& m) { return static_cast<double>(m.rope.overtwisted); }, whole, "overtwisted bonds"},
      {"overstretched", "", "bonds beyond the strain limit of the parameter set", Group::limits,
       [](const M& m) { return static_cast<double>(m.rope.overstretched); }, whole, "overstretched bonds"},
      {"largest_bond_twist_deg", "deg", "largest twist of one bond, absolute", Group::limits,
       [](const M& m) { return m.rope.largest_bond_twist / degree; }, real, "largest twist of a bond"},
      {"stress_GPa", "GPa",
       "tension, the mean of both ends, over the cross-section of the rope: for each tube a cell of the hexagonal "
       "packing",
       Group::load, [](const M& m) { return end_tension(m) / m.size.area / units::nN_nm; }},
      {"specific_stress_N_per_tex", "N/tex", "the same tension over the mass per length of the rope without load",
       Group::load, [](const M& m) { return end_tension(m) / m.size.mass_per_length; }},
  };
  const auto add = [&](Observable o) {
    if (std::any_of(entries.begin(), entries.end(), [&](const Observable& other) { return other.name == o.name; }))
      throw std::invalid_argument("a force term has the column " + o.name + ", and this name is taken");
    entries.push_back(std::move(o));
  };
  // Kinds register before main() begins, in no certain order with those who ask for the table there.
  static std::size_t terms = 0;
  for (; terms < term_kinds().size(); ++terms) {
    const TermKind& kind = term_kinds()[terms];
    const auto reading = [name = kind.name](const M& m) {
      const auto at = m.account.terms.find(name);
      return at == m.account.terms.end() ? TermReading() : at->second;
    };
    if (!kind.energy.empty())
      add({kind.name + "_eV", "eV", kind.energy, Group::energy, [reading](const M& m) { return reading(m).energy; },
           real, kind.name + " energy"});
    for (const TermColumn& c : kind.account)
      add({c.name, c.unit, c.meaning, Group::energy,
           [reading, value = c.value](const M& m) { return reading(m).account.*value; },
           c.value == &TermAccount::events || c.value == &TermAccount::begun});
  }
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

double lost_to_damping(const EnergyAccount& a) {
  double left = a.dissipated;
  for (const auto& [name, term] : a.terms) left -= term.account.lost + term.account.drag;
  return left;
}

double energy_balance(const EnergyAccount& a) {
  return a.potential.potential() + a.kinetic - a.work + a.dissipated - a.heat - a.first_energy;
}

double energy_drift(const EnergyAccount& a) {
  const double change = a.potential.potential() - a.first.potential();
  const double moved =
      a.kinetic + std::fabs(a.work) + std::fabs(a.heat) + std::fabs(a.dissipated) + std::fabs(change);
  constexpr double nothing = 1e-12;  // eV: bonds at rest hold rounding alone, and less than that
  const double at_rest = rounding * (a.potential.bonds() + std::fabs(a.potential.vdw)) + nothing;
  return std::fabs(energy_balance(a)) / (moved + at_rest);
}

std::vector<std::string> term_energy_columns() {
  std::vector<std::string> columns;
  for (const TermKind& kind : term_kinds())
    if (!kind.energy.empty()) columns.push_back(kind.name + "_eV");
  return columns;
}

const char* group_title(ObservableGroup group) {
  switch (group) {
    case Group::time:
      return "Time";
    case Group::load:
      return "Load";
    case Group::energy:
      return "Energy";
    case Group::tubes:
      return "Tubes";
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

std::string quantity_of(const Observable& o) {
  if (!o.label.empty()) return o.label;
  std::string name = o.name.substr(0, o.name.size() - suffix_of(o.unit).size());
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
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
