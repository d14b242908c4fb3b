// A rope of seven parallel tubes twisted by two rigid grips, with atoms (LAMMPS) and with elements.
//
// Atoms: armchair tubes side by side on a hexagonal lattice. Bands of atoms at both ends are the grips: they turn
// as one rigid body about the rope's axis, by plus and minus half of the angle, and everything between them is
// minimised at each increment. The potential acts inside of a tube, Lennard-Jones only between tubes.
//
// Clamped length. A band holds its atoms, so what deforms reaches from the last held row of atoms of one band to
// the first of the other: with n free rows, (n + 1) row distances, one more than the free atoms occupy. In the
// chain of elements it is the bonds that deform, so the innermost grip elements have their centres at those two
// held rows, and the clamped length is divided into whole bonds.
//
// Registry. A model of smooth tubes stands for the mean over registries. So each tube is turned about its own axis
// and shifted along it by parts of its symmetry that fill both evenly.
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
  int bonds = 0;           // of the clamped length; with 1.5 of them a grip should be as long as a band
  double step = 0;         // rad, between increments
  int increments = 0;
  int elastic_increments = 0;  // of these, inside of the elastic range: they are held to MD
  std::vector<std::string> remarks;
};

// Seven (10,10) tubes of 8.1 nm.
TwistedRope rope_7_10_10();

double row_distance(const ParameterSet& set);
double clamped_length(const TwistedRope& rope, const ParameterSet& set);

// Atoms of one tube of the rope, sorted: lower band, free part, upper band.
struct RopeTube {
  std::vector<Vector3> below, free, above;  // nm
};
std::vector<RopeTube> rope_atoms(const TwistedRope& rope, const ParameterSet& set);

// Pieces of a LAMMPS input with these atoms, tube by tube as types 1 to 7: the data file; one bonded potential for
// each tube, which is faster than one for all and cannot bond two tubes, and Lennard-Jones between tubes; and the
// groups below, above (the bands), held (both) and free.
std::string rope_data(const std::vector<RopeTube>& rope);
std::string rope_pairs(const Potential& potential, const UniversalLine& law);
std::string rope_groups(const std::vector<RopeTube>& rope);

// Columns axial_free, angle_rad, energy_eV, tersoff_eV, vdw_eV, moment_eV, force_eV_nm, rise_nm. Energies are
// absolute. The moment is that on the upper grip which the rope resists with, the force pulls the grips together,
// the rise is that of the upper grip where it is free along the axis. Runs LAMMPS in context.work.
ReferenceTable twist_atoms(const TwistedRope& rope, const CaseContext& context);

// One increment, of either.
struct TwistedState {
  double angle = 0;            // rad
  double total = 0;            // eV, as are the next two; their zero is that of the potential or of the bonds
  double tubes = 0, vdw = 0;   // inside of and between tubes
  double moment = 0;           // eV
  double force = 0, rise = 0;  // eV/nm, nm
  double bending = 0;          // eV, of `tubes`; of elements only
};
std::vector<TwistedState> states_of(const ReferenceTable& table, bool axial_free);
std::vector<TwistedState> twist_elements(const TwistedRope& rope, const ParameterSet& set, bool axial_free);

// Atoms (stored or fresh) against elements, grips fixed and free along the axis.
CaseResult run_twisted_rope(const TwistedRope& rope, const CaseContext& context);

// The case around it, of tubes "(5,5)" and a length in words.
Case twisted_rope_case(const TwistedRope& rope, const std::string& tube, const std::string& length);

}  // namespace ropewalk
