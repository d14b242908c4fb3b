#include "lammps/bond_vbond.hpp"

#include "lammps/fix_nve.hpp"
#include "lammps/pair_mdem.hpp"
#include "memory.h"
#include "neighbor.h"

namespace ropewalk::lammps {

BondVBond::~BondVBond() {
  if (allocated) memory->destroy(setflag);
}

void BondVBond::settings(int count, char** words) {
  if (count != 1)
    refuse(lmp, "bond_style mdem/vbond takes one word",
           "write: bond_style mdem/vbond DIR, DIR made by ropewalk export");
  check_atoms(lmp, "bond_style mdem/vbond");
  model_ = load(lmp, words[0]);
}

void BondVBond::coeff(int count, char**) {
  if (count != 1) refuse(lmp, "the scene has all coefficients of the bonds", "write: bond_coeff *");
  if (!allocated) memory->create(setflag, atom->nbondtypes + 1, "bond:setflag");
  allocated = 1;
  for (int k = 1; k <= atom->nbondtypes; ++k) setflag[k] = 1;
}

void BondVBond::init_style() {
  check_atoms(lmp, "bond_style mdem/vbond");
  check_styles(lmp, *model_);
}

double BondVBond::equilibrium_distance(int type) {
  return model_->topology.types[static_cast<std::size_t>(type - 1)].element_length;
}

BondForce BondVBond::evaluate(int i, int j, const Vector3& separation) const {
  double** q = orientations_;
  const TubeType& type = type_of(*model_, *atom, i);
  return bond_energy_and_gradient(type.bond, type.element_length, separation, frame_of(quaternion(q[i])),
                                  frame_of(quaternion(q[j])));
}

double BondVBond::single(int, double, int i, int j, double& fforce) {
  orientations_ = orientations(lmp);
  const int low = atom->tag[i] < atom->tag[j] ? i : j, high = low == i ? j : i;
  const Vector3 separation = vector(atom->x[high]) - vector(atom->x[low]);
  const BondForce f = evaluate(low, high, separation);
  fforce = f.force_j.dot(separation) / separation.squaredNorm();
  return f.energy.total();
}

// The virial of a bond. LAMMPS's own tally assumes a force along the bond, which this force is not.
void BondVBond::tally(int i, int j, const BondForce& f, const Vector3& separation) {
  const Vector3 &s = separation, &p = f.force_j;
  const double v[6] = {s.x() * p.x(), s.y() * p.y(), s.z() * p.z(), s.x() * p.y(), s.x() * p.z(), s.y() * p.z()};
  if (eflag_global) energy += f.energy.total();
  if (vflag_global)
    for (int k = 0; k < 6; ++k) virial[k] += v[k];
  for (const int at : {i, j}) {
    if (eflag_atom) eatom[at] += 0.5 * f.energy.total();
    if (vflag_atom)
      for (int k = 0; k < 6; ++k) vatom[at][k] += 0.5 * v[k];
  }
}

void BondVBond::refuse_slip(int element) const {
  refuse_one(lmp,
             "step " + std::to_string(update->ntimestep) + ", element " + std::to_string(element) +
                 ": the bond to the next element is twisted by 90 degrees and cannot carry more torque",
             "use shorter elements or less twist");
}

// The engine has computed the bonds with the contact.
void BondVBond::report(RankEngine& engine) {
  sum_ = engine.bond_energy();
  if (eflag_global) energy += sum_.total();
  if (vflag_global) {
    const std::array<double, 6> all = engine.virial(Parts::bonds);
    for (std::size_t k = 0; k < 6; ++k) virial[k] += all[k];
  }
  check_slip(engine);
}

void BondVBond::check_slip(const RankEngine& engine) const {
  if (engine.slipping_element() < 0) return;
  auto* motion = find_fix<FixNve>(lmp);
  if (!motion || !motion->will_go_back(FixNve::Failure::slip)) refuse_slip(engine.slipping_element());
}

void BondVBond::apply(int i, int j) {
  const Vector3 separation = vector(atom->x[j]) - vector(atom->x[i]);
  const BondForce f = evaluate(i, j, separation);
  sum_.stretch += f.energy.stretch;
  sum_.shear += f.energy.shear;
  sum_.bend += f.energy.bend;
  sum_.twist += f.energy.twist;
  add(atom->f[i], -f.force_j);
  add(atom->f[j], f.force_j);
  add(atom->torque[i], f.torque_i);
  add(atom->torque[j], f.torque_j);
  if (evflag) tally(i, j, f, separation);
  double** q = orientations_;
  const TubeType& type = type_of(*model_, *atom, i);
  const double angle =
      bond_twist_angle(type.bond, type.element_length, frame_of(quaternion(q[i])), frame_of(quaternion(q[j])));
  if (std::fabs(angle) >= 0.5 * units::pi) refuse_slip(element_of(*atom, i));
}

void BondVBond::compute(int eflag, int vflag) {
  ev_init(eflag, vflag);
  sum_ = {};
  if (RankEngine* engine = engine_of(lmp)) return report(*engine);
  orientations_ = orientations(lmp);
  for_bonds(*atom, neighbor->bondlist, neighbor->nbondlist, [&](int i, int j) { apply(i, j); });
}

}  // namespace ropewalk::lammps
