// Tables of contact energies, which `calibrate` writes beside a set and `calibrate fit` reads.
#pragma once

#include <string>
#include <vector>

#include "io/outputs.hpp"

namespace ropewalk::calibrate {

struct ContactRow {
  std::string kind;     // "density" (eV/nm^2), "parallel" (eV/nm) or "crossed" (eV)
  double distance = 0;  // nm
  double angle = 0;     // rad
  double energy = 0;
  double fit = 0;  // NaN if the table has no such column
  int line = 0;    // line of the file
};

std::vector<OutputColumn> contact_columns();

// Columns of contact_columns(), the last of them optional; lines that start with # are skipped. Throws
// InputError with file and line.
std::vector<ContactRow> read_contact_csv(const std::string& path);

}  // namespace ropewalk::calibrate
