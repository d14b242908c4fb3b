// Parameter set of one tube type: what calibrate writes and the simulator reads. One TOML file, format
// "ropewalk-parameters-1":
//
//   [meta]      format, name, chirality = [n, m], reference, doi
//   [tube]      radius (nm), atoms_per_length (1/nm), element_length (nm, default discretisation)
//               A tube of several walls has meta.walls = [[n, m], ...], inside first, in place of meta.chirality, and
//               meta.carried_by = "outer" | "all": the walls that carry stretch and torsion, "outer" where the walls
//               inside slide, "all" where all are gripped or linked. Its [tube] has contact_radius (nm, of the outer
//               wall) in place of radius, and atoms_per_length of all walls. [wall.1], [wall.2], ...: radius (nm),
//               atoms_per_length (1/nm), EA (nN), EI, GJ (nN nm^2) of each wall; [held.all], [held.outer]: EA, EI, GJ
//               of the tube by what carries it. [bond] has those of carried_by.
//   [lattice]   optional, of what is no carbon: name, species = ["B", "N"] of the two sublattices, bond_length (nm, of
//               the flat sheet), weight_1, weight_2 (u), and the Lennard-Jones laws between the atoms of two tubes:
//               epsilon_11, epsilon_12, epsilon_22 (eV), sigma_11, sigma_12, sigma_22 (nm)
//   [filament]  in place of [tube] and meta.chirality, for anything slender without a lattice:
//               contact_radius (nm, half of the distance at which the gap is zero), mass_per_length (u/nm; u:
//               atomic mass constant), element_length (nm); optional, at rest: curvature_1, curvature_2 (1/nm, about the
//               first and the second axis of the body) and twist_per_length (rad/nm, right-handed positive)
//   [bond]      EA (nN), EI (nN nm^2), GJ (nN nm^2); optional: kGA (nN). A filament may have EI_1 and EI_2 (nN nm^2,
//               about the two axes of the body) in place of EI.
//   [bond.anharmonic]  optional: e3, e2s, es2, s3, e4, e3s, e2s2, es3, s4, b4 (nN), the terms of anharmonic.hpp, and
//               min_strain, max_strain, max_shear, max_bend, the window in which they hold; needs [atomistic]
//   [bond.pull]   optional, needs [bond.anharmonic]: force = { values = [9 numbers], standard_errors = [9 numbers] }
//               (nN), of a tube that is pulled and not twisted, at equal steps of strain from max_strain to end;
//               end: largest strain that the atoms bear and that their potential describes; optional: start, the
//               max_strain, and edge_force (nN), the force of EA and [bond.anharmonic] there, both of the time when
//               the pull was made. Where they are missing they are what the set has now.
//   [contact.NAME]    present: the set has the contact law NAME, with the numbers that the law's reader names:
//               io/laws/paper.cpp, io/laws/line.cpp
//   [atomistic] optional: natural_twist (rad/nm), coupling (nN nm), poisson, energy_per_atom (eV),
//               sublattice_turn (rad), sublattice_rise and sublattice_lift (nm): how far the second sublattice has
//               moved against the first, around, along and off the axis
//   [validity]  kink_curvature (1/nm), twist_collapse (r tau), stretch (strain): limits of the model; optional:
//               endless_collapse (r tau), linear_curvature, linear_twist, linear_stretch: where a stiffness is 1 % off
//   [provenance] optional strings: what the set was made from and by
//   [[correlation]]  optional, any number: of = ["bond.EA", ...] and matrix = [[1, ...], ...], the correlations of the
//               standard errors of these quantities; quantities in none of them are independent
//
// Every number is an inline table { value, unit, standard_error, origin, doi, note }. The unit must be the one
// above; standard_error is a number or "not published"; doi may be left out where origin is not "published".
#pragma once

#include <algorithm>
#include <any>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "model/bond.hpp"
#include "model/honeycomb.hpp"
#include "model/tube.hpp"

namespace ropewalk {

inline constexpr const char* parameter_format = "ropewalk-parameters-1";

// One number of the file as it stands there, for tables and reports.
struct Quantity {
  std::string key;   // "bond.EA"
  double value = 0;  // in `unit`
  std::string unit;
  std::optional<double> standard_error;  // none: not published
  std::string origin;
  std::string doi;
  std::string note;
  bool of_carbon = true;  // interatomic potentials of carbon differ about it; false: of anything else
};

// Correlations of the standard errors of some quantities, by the fit that they come from.
struct Correlation {
  std::vector<std::string> of;              // keys
  std::vector<std::vector<double>> matrix;  // symmetric, 1 on the diagonal
};

// Beyond these the rigid-element model is no longer the tube.
struct Validity {
  double kink_curvature = 0;    // 1/nm
  double twist_collapse = 0;    // radius times twist per length: of a tube of 12 nm between held ends
  double stretch = 0;           // strain, tension or compression
  double endless_collapse = 0;  // twist_collapse of an endless tube; 0: not known
  double tension = 0;           // strain of a pulled bond, where atoms were pulled further; 0: stretch

  double largest_tension() const { return tension > 0 ? tension : stretch; }
  // twist_collapse of a tube of radius r and length L between held ends, which keep it round:
  //   c (1 + 3 (r/L)^(3/4)), at most that of 12 nm,   c = endless_collapse, or such that it fits 12 nm.
  // Fitted to (5,5), (10,10) and (15,15) of 12 to 94 nm (Tersoff), within 10 %. L = 0: endless.
  double collapse_at(double radius, double length) const {
    const auto held = [&](double at) { return 1 + 3 * std::pow(radius / at, 0.75); };
    const double endless = endless_collapse > 0 ? endless_collapse : twist_collapse / held(12);
    return std::min(twist_collapse, length > 0 ? endless * held(length) : endless);
  }
};

// One of the walls of a tube.
struct Wall {
  Chirality chirality;
  double radius = 0;            // nm
  double atoms_per_length = 0;  // 1/nm
};

struct ParameterSet {
  std::string name;
  std::string reference;
  std::string doi;
  bool filament = false;          // has [filament]: no lattice, and none of the two numbers that are of a lattice
  Honeycomb honeycomb;            // sheet that its walls are rolled from
  Chirality chirality;            // (n,m) of the outer wall; (0,0), which is no tube, for a filament
  std::vector<Wall> walls;        // walls of a tube that has several, inside first; else empty
  bool outer_carries = false;     // several walls: the outer one alone carries stretch and torsion
  double radius = 0;              // nm: of the wall of a tube, its contact radius too; contact_radius of a filament
  double atoms_per_length = 0;    // 1/nm; 0 for a filament
  double mass_per_length = 0;     // mass per length of a filament, eV ps^2/nm^3
  double element_length = 0;    // nm
  BondStiffness bond;           // eV/nm, eV nm; harmonic, with the natural shape of a filament
  std::optional<Anharmonic> anharmonic;
  std::optional<Pull> pull;                          // part of `anharmonic`, as the file has it
  std::array<double, PULL_STEPS + 1> pull_errors{};  // standard errors of its forces, eV/nm
  std::map<std::string, std::any> laws;              // numbers of contact laws, by name: io/law_numbers.hpp
  Validity validity;
  std::vector<Quantity> quantities;  // every number of the file, in its order, and what it leaves out of the pull
  std::vector<Correlation> correlations;
  std::vector<std::pair<std::string, std::string>> provenance;
  std::string path;  // where it was read from
  std::string hash;  // xxh64 of the file, hex

  // Numbers of the contact law that Numbers::law names; null if the set has none.
  template <class Numbers>
  const Numbers* law() const {
    const auto at = laws.find(Numbers::law);
    return at == laws.end() ? nullptr : std::any_cast<Numbers>(&at->second);
  }
  template <class Numbers>
  Numbers* law() {
    const auto at = laws.find(Numbers::law);
    return at == laws.end() ? nullptr : std::any_cast<Numbers>(&at->second);
  }

  // The largest strain to which bonds follow the atoms.
  double end_of_stretch() const {
    return pull ? pull->end : anharmonic ? anharmonic->max_strain : validity.stretch;
  }
  double element_mass(double length) const {
    return filament ? mass_per_length * length : atoms_per_length * length * honeycomb.mean_mass();
  }
  // The anharmonic bond where the set has one, of tubes of this length (nm; 0: endless), which collapse at
  // validity.collapse_at.
  BondStiffness anharmonic_bond(double tube_length) const {
    BondStiffness k = bond;
    if (!anharmonic) return k;
    k.anharmonic = *anharmonic;
    k.anharmonic.max_shear = std::min(anharmonic->max_shear, validity.collapse_at(radius, tube_length));
    return k;
  }
  // Isotropic inertia m r^2: exact about the tube axis; the transverse value of a thin tube,
  // m (r^2/2 + length^2/12), is 0.83 of it at length = 2 r. Published choice; no gyroscopic term. About the axis of
  // a solid filament it is twice the true one: its torsional waves are slower by a factor 1.4, its statics the same.
  // A tube of several walls has the sum of theirs.
  double element_inertia(double length) const {
    if (walls.empty()) return element_mass(length) * radius * radius;
    double sum = 0;
    for (const Wall& wall : walls) sum += wall.atoms_per_length * wall.radius * wall.radius;
    return element_mass(length) * sum / atoms_per_length;
  }
};

}  // namespace ropewalk
