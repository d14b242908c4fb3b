// Values of elements to colour by, and what the formats of frames call them.
#pragma once

#include <array>
#include <vector>

#include "io/outputs.hpp"

namespace ropewalk {

// Per-element values to colour by.
struct ElementColours {
  std::vector<double> bond_energy;     // eV: half of each adjoining bond
  std::vector<double> vdw_energy;      // eV: half of each pair
  std::vector<double> bending_moment;  // eV: EI times curvature
  std::vector<double> twist_angle;     // rad: mean of the adjoining bonds
};

// ASE keeps no column of a dump that it does not know, but for those that begin with c_.
struct ColourColumn {
  OutputColumn column;
  const char* in_dump;
  std::vector<double> ElementColours::*values;
};

inline constexpr std::array<ColourColumn, 4> colour_columns = {{
    {{"bond_energy_eV", "eV", "half of the energy of each bond of the element"},
     "c_bond_energy_eV",
     &ElementColours::bond_energy},
    {{"vdw_energy_eV", "eV", "half of the energy of each contact of the element"},
     "c_vdw_energy_eV",
     &ElementColours::vdw_energy},
    {{"bending_moment_eV", "eV", "bending moment: EI times curvature"},
     "c_bending_moment_eV",
     &ElementColours::bending_moment},
    {{"twist_angle_rad", "rad", "twist angle, mean of the bonds of the element"},
     "c_twist_angle_rad",
     &ElementColours::twist_angle},
}};

// Whether there is a value for each element.
inline bool given(const ElementColours& colours, const ColourColumn& column, std::size_t elements) {
  return elements > 0 && (colours.*column.values).size() == elements;
}

}  // namespace ropewalk
