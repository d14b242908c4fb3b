// Parameter set of one tube type: what calibrate writes and the simulator reads. One TOML file, format
// "ropewalk-parameters-1":
//
//   [meta]      format, name, chirality = [n, m], reference, doi
//   [tube]      radius (nm), atoms_per_length (1/nm), element_length (nm, default discretisation)
//   [bond]      EA (nN), EI (nN nm^2), GJ (nN nm^2)
//   [contact.paper]   present: the set has the `paper` law; epsilon (eV), A, B, alpha, beta, C1 .. C5,
//               C_gamma, delta, freeze, switch_start, cutoff (all in units of the radius), core_gap
//   [validity]  kink_curvature (1/nm), twist_collapse (r tau), stretch (strain): limits of the model
//
// Every number is an inline table { value, unit, standard_error, origin, doi }. The unit must be the one
// above; standard_error is a number or "not published"; doi may be left out where origin is not "published".
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "model/bond.hpp"
#include "model/contact_paper.hpp"
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
};

// Beyond these the rigid-element model is no longer the tube.
struct Validity {
  double kink_curvature = 0;  // 1/nm
  double twist_collapse = 0;  // radius times twist per length
  double stretch = 0;         // strain, tension or compression
};

struct ParameterSet {
  std::string name;
  std::string reference;
  std::string doi;
  Chirality chirality;
  double radius = 0;            // nm
  double atoms_per_length = 0;  // 1/nm
  double element_length = 0;    // nm
  BondStiffness bond;           // eV/nm, eV nm
  std::optional<PaperContact> paper;
  Validity validity;
  std::vector<Quantity> quantities;  // every number of the file, in its order
  std::string path;                  // where it was read from
  std::string hash;                  // xxh64 of the file, hex

  double element_mass(double length) const { return atoms_per_length * length * units::carbon_mass; }
  // Isotropic inertia m r^2: exact about the tube axis; the transverse value of a thin tube,
  // m (r^2/2 + length^2/12), is 0.83 of it at length = 2 r. Published choice; no gyroscopic term.
  double element_inertia(double length) const { return element_mass(length) * radius * radius; }
};

}  // namespace ropewalk
