// Interatomic potentials of carbon that the calibration knows, and a user's own.
#pragma once

#include <string>
#include <vector>

namespace ropewalk {

struct Potential {
  std::string name;                   // "tersoff", "airebo", "rebo", "lcbop", or "user"
  std::string pair_style;             // "tersoff"
  std::vector<std::string> commands;  // the pair_style and pair_coeff lines, one atom type
  std::string file;                   // absolute path of the potential file; empty where there is none
  std::string file_hash;              // xxh64
  std::string reference, doi;
  double cutoff = 0;  // nm, largest interaction distance: a bound for cell sizes
  double inner = 0;   // nm, length from which bonds are cut off, and their force rises falsely; 0: not known
};

// Throws InputError for an unknown name (with the nearest known one) and for a potential file that is missing.
Potential find_potential(const std::string& name);

// A file with the user's own pair_style and pair_coeff lines (one atom type, metal units).
Potential user_potential(const std::string& path);

}  // namespace ropewalk
