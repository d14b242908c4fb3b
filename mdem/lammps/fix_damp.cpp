#include "lammps/fix_damp.hpp"

#include "lammps/bond_vbond.hpp"
#include "lammps/pair_mdem.hpp"
#include "neighbor.h"

namespace ropewalk::lammps {

FixDamp::FixDamp(LMP::LAMMPS* lmp, int count, char** words) : Fix(lmp, count, words) {
  if (count != 3 || igroup != 0)
    refuse(lmp, "fix mdem/damp takes no words and acts on all elements", "write: fix damping all mdem/damp");
  model_ = loaded(lmp, "fix mdem/damp");
}

void FixDamp::apply(const DampingForce& d, int i, int j) {
  add(atom->f[i], -d.force_j);
  add(atom->f[j], d.force_j);
  add(atom->torque[i], d.torque_i);
  add(atom->torque[j], d.torque_j);
  power_ += d.power;
}

void FixDamp::contacts() {
  const ContactViscosity& viscosity = model_->interaction.damping.contact;
  const double reach = std::min(viscosity.outer, model_->interaction.cutoff());
  for_contacts(lmp, *force->pair, *model_, [&](int i, int j) {
    const Vector3 separation = vector(atom->x[j]) - vector(atom->x[i]);
    if (separation.squaredNorm() < reach * reach)
      apply(viscosity.force(separation, vector(atom->v[i]), vector(atom->omega[i]), vector(atom->v[j]),
                            vector(atom->omega[j])),
            i, j);
  });
}

void FixDamp::bonds() {
  const BondDamping& damping = model_->interaction.damping.bond;
  for_bonds(*atom, neighbor->bondlist, neighbor->nbondlist, [&](int i, int j) {
    const TubeType& type = type_of(*model_, *atom, i);
    apply(damping.force(type.mass, type.inertia, vector(atom->x[j]) - vector(atom->x[i]), vector(atom->v[i]),
                        vector(atom->omega[i]), vector(atom->v[j]), vector(atom->omega[j])),
          i, j);
  });
}

void FixDamp::pre_reverse(int, int) {
  if (engine_of(lmp)) return;  // which has all dampings
  power_ = 0;
  if (model_->interaction.has_contact() && model_->interaction.damped_contact()) contacts();
  if (model_->interaction.damping.bond.rate > 0) bonds();
}

}  // namespace ropewalk::lammps
