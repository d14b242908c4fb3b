// Files that name what a tube is made of: the species of its honeycomb, their potentials and their contact.
//
//   format = "ropewalk-atoms-1", name, species = ["B", "N"], weight_u = [2], bond_length_nm (of the flat sheet, to
//   begin with)
//   [[potential]]    one or more, the first is the default: name, pair_style (LAMMPS, with its arguments), file (in
//   the
//                    folders of potentials, or beside this one), elements = ["B", "N"] (there), cutoff_nm (largest
//                    range of a bond), bond_cutoff_nm (length from which bonds are cut off), reference; optional:
//                    doi
//   [lennard_jones]  between atoms of two tubes: epsilon_eV = [2], sigma_nm = [2], reference; optional: doi, and
//   epsilon_12_eV
//                    and sigma_12_nm of two unlike atoms, otherwise by Lorentz and Berthelot
#pragma once

#include <string>
#include <vector>

#include "atoms/potential.hpp"
#include "model/parameters.hpp"

namespace ropewalk {

inline constexpr const char* atoms_format = "ropewalk-atoms-1";

// The potential `name` (empty: the first) of what `atoms` names: "C", a shipped file as "BN", or a file. Throws
// InputError where there is none, or the file or its potential file is missing or wrong.
Potential potential_of_atoms(const std::string& atoms, const std::string& name);

// The potential of this name for the atoms of a set, which its provenance names.
Potential potential_of(const ParameterSet& set, const std::string& name);

}  // namespace ropewalk
