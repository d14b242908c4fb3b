// A rope of seven parallel tubes twisted by two rigid grips, with atoms (LAMMPS) and with elements.
//
// Atoms: armchair tubes side by side on a hexagonal lattice. The bands of atoms at both ends are the grips. They
// turn as rigid bodies about the rope's axis by plus and minus half of the angle; the atoms between them are
// relaxed at each increment. The bonded potential acts within a tube, Lennard-Jones only between tubes.
//
// Clamped length. The deforming part reaches from the last held row of atoms of one band to the first of the other:
// with n free rows it is (n + 1) row distances, one more than the free atoms occupy. In a chain of elements the
// bonds deform. So the innermost grip elements have their centres at those two held rows, and the clamped length is
// divided into whole bonds.
//
// Registry. A model of smooth tubes stands for the mean over registries. So each tube is turned about its own axis
// and shifted along it, by parts of its symmetry that fill both evenly.
#pragma once

#include <string>
#include <vector>

#include "atomistic/potential.hpp"
#include "core/case.hpp"
#include "core/reference.hpp"
#include "model/bond.hpp"

namespace ropewalk {

struct TwistedRope {
  std::string name;        // of the case and of its reference
  std::string parameters;  // "cnt-5-5-tersoff"
  int free_rows = 0;       // rows of atoms between the bands, half a period apart
  int band_rows = 0;       // in each band
  int bonds = 0;           // within the clamped length; 1.5 of them should be as long as a band
  double step = 0;         // rad, between increments
  int increments = 0;
  int elastic_increments = 0;  // of these, within the elastic range: they are compared with the atoms
  std::vector<int> collapsed;  // increments beyond the collapse of the walls, compared within 10 %
  std::vector<bool> axial_free = {false, true};  // the series: grips fixed, and free along the axis
  std::vector<std::string> remarks;
};

// Seven (10,10) tubes of 8.1 nm: of a case, and of the chart of speed against accuracy.
TwistedRope rope_7_10_10();
// The same, twisted until the walls have collapsed, with fixed grips.
TwistedRope collapsed_rope_7_10_10();

double row_distance(const ParameterSet& set);
double clamped_length(const TwistedRope& rope, const ParameterSet& set);

// Atoms of one tube of the rope, sorted: lower band, free part, upper band.
struct RopeTube {
  std::vector<Vector3> below, free, above;  // nm
};
std::vector<RopeTube> rope_atoms(const TwistedRope& rope, const ParameterSet& set);

// Parts of a LAMMPS input with these atoms, tube by tube as types 1 to 7: the data file; the potentials; and the
// groups below, above (the bands), held (both) and free. Every tube has a bonded potential of its own, which is
// faster than one for all and cannot bond two tubes; Lennard-Jones acts between tubes.
std::string rope_data(const std::vector<RopeTube>& rope);
std::string rope_pairs(const Potential& potential, const UniversalLine& law);
std::string rope_groups(const std::vector<RopeTube>& rope);

// Columns axial_free, angle_rad, energy_eV, tersoff_eV, vdw_eV, moment_eV, force_eV_nm, rise_nm. Energies are
// absolute. The moment is the resistance of the rope on the upper grip, the force pulls the grips together, the
// rise is the motion of the upper grip where it is free along the axis. Runs LAMMPS in context.work.
ReferenceTable twist_atoms(const TwistedRope& rope, const CaseContext& context);

// One increment, of atoms or of elements.
struct TwistedState {
  double angle = 0;            // rad
  double total = 0;            // eV, as are the next two; with the zero of the potential or of the bonds
  double tubes = 0, vdw = 0;   // within and between tubes
  double moment = 0;           // eV
  double force = 0, rise = 0;  // eV/nm, nm
  double bending = 0;          // eV, of `tubes`; of elements only
};
std::vector<TwistedState> states_of(const ReferenceTable& table, bool axial_free);
std::vector<TwistedState> twist_elements(const TwistedRope& rope, const ParameterSet& set, bool axial_free);

// Compares elements with atoms (stored or fresh), with the grips fixed and free along the axis.
CaseResult run_twisted_rope(const TwistedRope& rope, const CaseContext& context);

// A case of this rope, without its order and its faults; `tube` as "(5,5)", `length` in nm.
Case twisted_rope_case(const TwistedRope& rope, const std::string& tube, const std::string& length);

}  // namespace ropewalk
