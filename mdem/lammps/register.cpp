#include "lammps/register.hpp"

#include "force.h"
#include "lammps/bond_vbond.hpp"
#include "lammps/fix_damp.hpp"
#include "lammps/fix_grip.hpp"
#include "lammps/fix_nve.hpp"
#include "lammps/fix_relax.hpp"
#include "lammps/fix_states.hpp"
#include "lammps/pair_mdem.hpp"
#include "modify.h"

namespace ropewalk::lammps {
namespace {

LMP::Pair* make_paper(LMP::LAMMPS* lmp) { return new PairMdem(lmp, "paper"); }
LMP::Pair* make_none(LMP::LAMMPS* lmp) { return new PairMdem(lmp, "none"); }
LMP::Pair* make_line(LMP::LAMMPS* lmp) { return new PairMdem(lmp, "line"); }
LMP::Bond* make_bond(LMP::LAMMPS* lmp) { return new BondVBond(lmp); }
template <class F>
LMP::Fix* make_fix(LMP::LAMMPS* lmp, int count, char** words) {
  return new F(lmp, count, words);
}

}  // namespace

const PairEntry pair_entries[3] = {{"mdem/paper", make_paper}, {"mdem/line", make_line}, {"mdem/none", make_none}};
const BondEntry bond_entries[1] = {{"mdem/vbond", make_bond}};
const FixEntry fix_entries[5] = {{"mdem/nve", make_fix<FixNve>},
                                 {"mdem/relax", make_fix<FixRelax>},
                                 {"mdem/damp", make_fix<FixDamp>},
                                 {"mdem/grip", make_fix<FixGrip>},
                                 {"mdem/states", make_fix<FixStates>}};

void register_styles(LMP::LAMMPS* lmp) {
  for (const PairEntry& e : pair_entries) (*lmp->force->pair_map)[e.name] = e.make;
  for (const BondEntry& e : bond_entries) (*lmp->force->bond_map)[e.name] = e.make;
  for (const FixEntry& e : fix_entries) (*lmp->modify->fix_map)[e.name] = e.make;
}

}  // namespace ropewalk::lammps
