// A rope of seven parallel tubes twisted by two rigid grips, with atoms (LAMMPS) and with elements.
//
// Atoms: tubes side by side on a hexagonal lattice. The bands of atoms at both ends are the grips. They
// turn as rigid bodies about the rope's axis by plus and minus half of the angle; the atoms between them are
// relaxed at each increment. The bonded potential acts within a tube, Lennard-Jones only between tubes.
//
// Rows. A row is gcd(n,m) hexagons: of an armchair tube a ring of atoms, half a period high.
//
// Clamped length. Where a band ends, bonds join held atoms with free ones. The deforming part reaches from the mean
// height of these held atoms at one band to that at the other; of an armchair tube with n free rows it is (n + 1)
// row heights, one more than the free atoms occupy. In a chain of elements the bonds deform. So the innermost grip
// elements have their centres at those two heights, and the clamped length is divided into whole bonds.
//
// Registry. A model of smooth tubes stands for the mean over registries. So each tube is turned about its own axis
// and shifted along it, by parts of its symmetry that fill both evenly.
//
// Twist at the start: tubes have the natural twist of their set, at which its bonds are at rest.
#pragma once

#include <string>
#include <vector>

#include "atoms/lattice.hpp"
#include "cases/common/lammps_session.hpp"
#include "core/case.hpp"
#include "core/reference.hpp"
#include "model/bond.hpp"
#include "model/contact/line_parameters.hpp"

namespace ropewalk::validate {

struct TwistedRope {
  std::string name;   // name of the table of references
  int free_rows = 0;  // between the bands
  int band_rows = 0;  // rows in each band
  int bonds = 0;      // within the clamped length; 1.5 of them should be as long as a band
};
// About `length` nm between bands of 1 nm, with bonds of 0.62 nm.
TwistedRope rope_of_length(const std::string& name, double length, const ParameterSet& set);

double row_distance(const ParameterSet& set);
double clamped_length(const TwistedRope& rope, const ParameterSet& set);

// Angles between the grips (rad): of the stored table or, without one, from 0 in even increments to r tau =
// `shear`.
std::vector<double> angles_of(const TwistedRope& rope, const ParameterSet& set, const CaseContext& context,
                              double shear, int increments);

// Atoms of one tube of the rope, sorted: lower band, free part, upper band.
struct RopeTube {
  std::vector<Vector3> below, free, above;  // nm
};
std::vector<RopeTube> rope_atoms(const TwistedRope& rope, const ParameterSet& set, const TubeShape& shape);
// The same with the radius and the lengths of the set.
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
ReferenceTable twist_atoms(const TwistedRope& rope, const ParameterSet& set, const std::vector<double>& angles,
                           const std::vector<bool>& axial_free, const CaseContext& context);

// One increment, of atoms or of elements.
struct TwistedState {
  double angle = 0;            // rad
  double total = 0;            // eV, as are the next two; with the zero of the potential or of the bonds
  double tubes = 0, vdw = 0;   // within and between tubes
  double moment = 0;           // eV
  double force = 0, rise = 0;  // eV/nm, nm
  double bending = 0;          // bending part of `tubes`, eV; elements have it alone
};
std::vector<TwistedState> states_of(const ReferenceTable& table, bool axial_free);
std::vector<TwistedState> twist_elements(const TwistedRope& rope, const ParameterSet& set,
                                         const std::vector<double>& angles, bool axial_free);

// The comparison for each tube of a case.
struct RopeComparison {
  std::string name;     // name of the table
  double length = 8;    // nm
  double shear = 0.04;  // r tau of the last increment, where none are stored
  int increments = 6;
  std::vector<bool> axial_free = {false, true};  // the series: grips fixed, and free along the axis
  std::vector<double> collapsed;                 // degrees beyond the collapse, compared within 10 %
};
// A case of such ropes, without its order, its sets and its faults.
Case twisted_rope_case(const RopeComparison& comparison);

}  // namespace ropewalk::validate
