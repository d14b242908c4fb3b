// The numbers of the contact law `line` in a parameter set.
#pragma once

#include "model/contact/line.hpp"

namespace ropewalk {

// The law, with the input of its integrals.
struct LineParameters {
  static constexpr const char* law = "line";

  double surface_density = 0;  // atoms per nm^2
  LineDensity density;         // line density of two tubes of this kind
  double pair_spacing = 0;     // nm
  double pair_energy = 0;      // eV/nm
  double cross90_energy = 0;   // eV
  UniversalLine universal;     // also epsilon, sigma and cutoff of the atom-atom law
  bool has_universal = false;
};

}  // namespace ropewalk
