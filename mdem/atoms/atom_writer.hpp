// Atoms of elements as files for other programs: LAMMPS data (atom_style molecular: the molecule is the tube, from
// 1, and the type the part of a tube, from 1; a part of two species has two types, one after the other) and
// extended XYZ (with columns tube and tube_element, from 0). Lengths in Angstrom. Written atom by atom, so that
// memory does not grow with their number.
#pragma once

#include <string>
#include <vector>

#include "atoms/elements_to_atoms.hpp"

namespace ropewalk {

inline constexpr double angstrom = 0.1;  // nm: LAMMPS's metal units

enum class AtomFormat { lammps_data, extended_xyz };
// The end of the name tells the format: .data, .xyz or .extxyz. Throws InputError.
AtomFormat atom_format_of(const std::string& path);

// Atoms `first` .. `last` of a file, from 1, are those of an element of a tube.
struct AtomRange {
  int part = 0, tube = 0, element = 0;  // tube and element from 0
  long first = 0, last = 0;
};

class Draft;

// `title`: one line. Returns which atoms are of which element. Throws InputError where the file cannot be written.
std::vector<AtomRange> write_atoms(const std::string& path, AtomFormat format, const AtomsOfElements& atoms,
                                   const std::string& title, double time_ps);
// The same into a draft, which is then on the disk.
std::vector<AtomRange> write_atoms(Draft& file, AtomFormat format, const AtomsOfElements& atoms,
                                   const std::string& title, double time_ps);

}  // namespace ropewalk
