// LAMMPS on the atoms of elements: an input that minimises their energy with their ends held.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "atoms/atom_writer.hpp"
#include "atoms/lammps.hpp"
#include "atoms/potential.hpp"
#include "model/contact/line.hpp"

namespace ropewalk {

// The forces between atoms: a potential within each tube, and a Lennard-Jones law between the tubes.
struct AtomForces {
  Potential potential;
  double epsilon = 0, sigma = 0, cutoff = 0;  // eV, nm
  int species() const { return potential.honeycomb.one_species() ? 1 : 2; }
};
// Forces between the atoms of tubes whose sets agree on the honeycomb and on the Lennard-Jones law. `potential`: a
// name or a file of pair_style and pair_coeff lines; empty: that of the sets. Throws InputError where they name
// none, or several.
AtomForces atom_forces(const std::vector<ParameterSet>& sets, const std::string& potential);

// The pair_style and pair_coeff lines for tubes whose atoms are of the types 1 .. parts; of two species, two types
// a part.
std::string pair_lines(const AtomForces& forces, std::size_t parts);

// LAMMPS input that reads STEM.data, in which each part of a tube is a type. It writes STEM-relaxed.data, and the
// energies of the free atoms of all parts, before and after, to STEM-before.txt and STEM-after.txt. `held`: ranges
// of atoms that stay where they are.
std::string relax_input(const std::string& stem, const AtomForces& forces, std::size_t parts,
                        const std::vector<AtomRange>& held);

struct PartEnergies {
  double before = 0, after = 0;  // eV, half of each contact included
};
// Runs the input in a folder that has STEM.data. Throws LammpsError.
std::vector<PartEnergies> relax_atoms(const std::string& folder, const std::string& stem, const AtomForces& forces,
                                      std::size_t parts, const std::vector<AtomRange>& held,
                                      const LammpsOptions& options);

}  // namespace ropewalk
