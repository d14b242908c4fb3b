// Finite specimens of atoms between two held bands, of two lengths, whose energies are differenced: stiffnesses by states
// that are each made from the specimen at rest.
#pragma once

#include <string>
#include <vector>

#include "cases/common/lammps_session.hpp"

namespace ropewalk::validate {

// The largest strain, wall shear (radius times twist) and bend strain (radius times curvature).
struct Amplitudes {
  double strain = 0, shear = 0, bend = 0;
};

struct SpecimenState {
  double strain = 0, twist = 0, curvature = 0;  // 1, rad/nm, 1/nm
};
// At rest, stretched and compressed, twisted in both senses, and bent.
std::vector<SpecimenState> specimen_states(const Amplitudes& most, double radius);

// LAMMPS commands that relax the specimen, and then each state, down to a norm of the forces (eV/Angstrom). `report`
// appends a line of results. The commands before them have made the fix `ref`, which keeps the straight positions,
// and the variables `half`, half of the free length, and `led`, 1 for atoms that are strained and twisted.
std::string specimen_commands(const std::vector<SpecimenState>& states, double force, const std::string& report);

// Planes of bending (rad) whose mean has no more of the azimuths of both ends: one for a tube that has a threefold axis.
std::vector<double> bending_planes(Chirality c);

// The states of one way of holding, and their energies per length above rest (eV/nm).
struct SpecimenEnergies {
  std::vector<SpecimenState> states;
  std::vector<double> energy;
};
// The columns of a table of references, with a number for the way of holding, and its rows of one way.
std::vector<std::string> specimen_columns();
void add_specimen_rows(ReferenceTable& table, int way, const SpecimenEnergies& energies);
SpecimenEnergies specimen_rows(const ReferenceTable& table, int way);

// Holds EA, GJ and EI of a bond to those of the atoms, as means over both signs, and draws the energies.
void compare_stiffnesses(const std::string& name, const SpecimenEnergies& atoms, const BondStiffness& bond,
                         double element_length, double tolerance, CaseResult& result);

}  // namespace ropewalk::validate
