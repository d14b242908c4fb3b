// Two tubes of frozen relaxed atoms with Lennard-Jones between them, and rows of elements in the same place.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "cases/common/lammps_session.hpp"
#include "model/contact/contact.hpp"
#include "model/contact/line.hpp"

namespace ropewalk::validate {

// How the atoms of two tubes are turned and shifted, in parts of a symmetry turn or of a period, 0 .. 1.
struct Registry {
  double turn_i = 0, turn_j = 0, shift_i = 0, shift_j = 0;
};
// The first `count` of a sequence that fills the four dimensions evenly.
std::vector<Registry> registries(int count);

// The atoms of a tube turned and shifted by parts of its symmetry, with their middle at z = 0.
std::vector<Vector3> centred_tube(Chirality c, const TubeShape& shape, long hexagons, double turn, double shift);

// LAMMPS commands that read the atoms as groups `one` and `two` (types 1 and 2; of two species 1, 2 and 3, 4).
// Lennard-Jones acts only between these groups, by the session's law, or by its laws between species.
std::string pair_commands(const MdSession& session, const std::string& boundary, const std::string& data);
// Moves group `two` (nm).
std::string move_two(const Vector3& by);
// Appends the values, given as immediate variables, to name.dat.
std::string print_values(const std::string& name, const std::string& values);

// Two equal tubes of `hexagons` hexagons at this distance (nm), frozen in a periodic cell, one of them slid over
// `range` (nm), for several turns of either: rows of both turns (rad), the shift (nm) and the energy per length
// (eV/nm).
struct SlidPairs {
  long hexagons = 0;
  double distance = 0, range = 0;
  int turns = 0, shifts = 0;
};
std::vector<std::vector<double>> slid_pairs(MdSession& session, const std::string& name, Chirality c,
                                            const TubeShape& shape, const SlidPairs& pairs);

// Mean and standard deviation of a value over `registries` registries.
struct Spread {
  double mean = 0, deviation = 0;
};
Spread spread_over(int registries, const std::function<double(std::size_t)>& value);

// The line law of a scene with these tubes, alike or not, and elements of this length (nm).
LineContact contact_of(const ParameterSet& i, const ParameterSet& j, double element_length);

// A straight row of elements.
struct ElementRow {
  Vector3 centre = Vector3::Zero(), axis = Vector3::UnitZ();
  int elements = 1;
};
// Energy (eV), force on row j (eV/nm) and torques about the rows' centres (eV).
PairForce row_contact(const LineContact& contact, const ElementRow& i, const ElementRow& j);
// Energy per length (eV/nm) of two long parallel rows, element j displaced by `shift`.
double parallel_rows(const LineContact& contact, double distance, double shift = 0);

// Minimum of a tabulated curve: that of a quartic fitted to the points within `reach` (nm) of the lowest.
LineWell lowest_of(const std::vector<double>& distance, const std::vector<double>& energy, double reach);

}  // namespace ropewalk::validate
