// The names of the styles, for lmp-ropewalk and for the plugin.
#pragma once

#include "bond.h"
#include "fix.h"
#include "lammps.h"
#include "pair.h"

namespace ropewalk::lammps {

struct PairEntry {
  const char* name;
  LAMMPS_NS::Pair* (*make)(LAMMPS_NS::LAMMPS*);
};
struct BondEntry {
  const char* name;
  LAMMPS_NS::Bond* (*make)(LAMMPS_NS::LAMMPS*);
};
struct FixEntry {
  const char* name;
  LAMMPS_NS::Fix* (*make)(LAMMPS_NS::LAMMPS*, int, char**);
};

extern const PairEntry pair_entries[3];
extern const BondEntry bond_entries[1];
extern const FixEntry fix_entries[5];

// Registers the styles with a LAMMPS instance.
void register_styles(LAMMPS_NS::LAMMPS* lmp);

}  // namespace ropewalk::lammps
