// Tables of contact energies: what calibrate writes beside a set and what a user may bring to `calibrate fit`.
#pragma once

#include <string>
#include <vector>

namespace ropewalk {

struct ContactRow {
  std::string kind;     // "density" (eV/nm^2), "parallel" (eV/nm) or "crossed" (eV)
  double distance = 0;  // nm
  double angle = 0;     // rad
  double energy = 0;
  double fit = 0;  // NaN where the table has no such column
};

// Columns kind,distance_nm,angle_deg,energy and optionally fit; lines that start with # are skipped. Throws
// InputError with file and line.
std::vector<ContactRow> read_contact_csv(const std::string& path);

}  // namespace ropewalk
