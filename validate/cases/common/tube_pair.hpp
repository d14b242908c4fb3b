// Two tubes of frozen relaxed atoms with Lennard-Jones between them, and rows of elements in the same place.
#pragma once

#include <string>
#include <vector>

#include "cases/common/lammps_session.hpp"
#include "model/contact/contact.hpp"
#include "model/contact/line.hpp"

namespace ropewalk {

// Where the atoms of two tubes lie against each other, all in turns or parts of a period, 0 .. 1.
struct Registry {
  double turn_i = 0, turn_j = 0, shift_i = 0, shift_j = 0;
};
// The first of a sequence that fills the four evenly.
std::vector<Registry> registries(int count);

// Reads the atoms as groups `one` and `two` (types 1 and 2), between which alone Lennard-Jones acts.
std::string pair_commands(const AtomLaw& law, const std::string& boundary, const std::string& data);
std::string pair_data(const std::vector<Vector3>& one, const std::vector<Vector3>& two, double half_width,
                      double z_low, double z_high);
// Moves group `two` (nm).
std::string move_two(const Vector3& by);
// Appends what the immediate variables say to name.dat.
std::string print_values(const std::string& name, const std::string& values);

// The contact of elements of one length, of like or unlike tubes, as a scene has it.
LineContact contact_of(const ParameterSet& i, const ParameterSet& j, double element_length);

// A straight row of elements.
struct ElementRow {
  Vector3 centre = Vector3::Zero(), axis = Vector3::UnitZ();
  int elements = 1;
};
// Energy, force on row j and torques about the rows' centres.
PairForce row_contact(const LineContact& contact, const ElementRow& i, const ElementRow& j);
// Energy per length (eV/nm) of two long parallel rows, element j displaced by `shift`.
double parallel_rows(const LineContact& contact, double distance, double shift = 0);

// The lowest point of a tabulated curve: a quartic through the points within `reach` of the lowest.
LineWell lowest_of(const std::vector<double>& distance, const std::vector<double>& energy, double reach);

}  // namespace ropewalk
