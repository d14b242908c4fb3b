// Interatomic potentials of carbon that the calibration knows, and others by their lines.
#pragma once

#include <string>
#include <vector>

#include "model/error.hpp"
#include "model/honeycomb.hpp"

namespace ropewalk {

struct Potential {
  std::string name;                   // "tersoff", "airebo", "rebo", "lcbop", or "user"
  std::string pair_style;             // "tersoff"
  std::vector<std::string> commands;  // the pair_style and pair_coeff lines, a type for each species
  std::string file;                   // absolute path of the potential file; empty where there is none
  std::string file_hash;              // xxh64
  std::string reference, doi;
  double cutoff = 0;  // nm, largest interaction distance: a bound for cell sizes
  double inner = 0;   // nm, length from which bonds are cut off, and their force rises falsely; 0: not known
  Honeycomb honeycomb;  // whose atoms the commands name: type 1 is the first sublattice, type 2 a second species
  std::string atoms;    // where it comes from, "BN" or a file; empty: carbon
  std::string pairs_reference, pairs_doi;  // sources of honeycomb.pairs
};

// A potential as it is written down.
struct PotentialLines {
  std::string name, style, file;      // style: with its arguments
  std::vector<std::string> elements;  // element of each type of atoms
  double cutoff = 0, inner = 0;       // nm
  std::string reference, doi;
  std::string folder;  // where the file may lie beside the folders of potentials
};
// Throws InputError where its file is missing.
Potential potential_of_lines(const PotentialLines& lines);

// Throws InputError at `place` for a text that would reach beyond its line in an input of LAMMPS.
void refuse_reach(const InputError::Place& place, const std::string& text);

// Throws InputError for an unknown name (with the nearest known one) and for a potential file that is missing.
Potential find_potential(const std::string& name);

// A file with the user's own pair_style and pair_coeff lines (one atom type, metal units).
Potential user_potential(const std::string& path);

}  // namespace ropewalk
