#include "lammps/pair_mdem.hpp"

#include <utility>

#include "memory.h"
#include "neighbor.h"
#include "sim/contact/contact_law.hpp"
#include "sim/forces/force_term.hpp"
#include "sim/state/part_of_scene.hpp"
#include "utils.h"

namespace ropewalk::lammps {

PairMdem::PairMdem(LMP::LAMMPS* lmp, std::string law) : Pair(lmp), law_(std::move(law)) {
  single_enable = 0;  // the energy depends on more than a distance
  restartinfo = 0;    // all of it is in the scene
  one_coeff = 1;
}

PairMdem::~PairMdem() {
  if (!allocated) return;
  memory->destroy(setflag);
  memory->destroy(cutsq);
}

void PairMdem::allocate() {
  const int types = atom->ntypes;
  memory->create(setflag, types + 1, types + 1, "pair:setflag");
  memory->create(cutsq, types + 1, types + 1, "pair:cutsq");
  for (int i = 1; i <= types; ++i)
    for (int j = 1; j <= types; ++j) setflag[i][j] = 0;
  allocated = 1;
}

void PairMdem::settings(int count, char** words) {
  const std::string name = "pair_style mdem/" + law_;
  const bool plain = count == 2 && std::string(words[1]) == "plain";
  if (count != 1 && !plain && !(count == 2 && std::string(words[1]) == "engine"))
    refuse(lmp, name + " takes a directory, and how forces are computed",
           "write: " + name + " DIR, DIR made by ropewalk export, or " + name + " DIR plain");
  check_atoms(lmp, name.c_str());
  model_ = load(lmp, words[0]);
  if (model_->law != law_)
    refuse(lmp, "the scene's contact is \"" + model_->law + "\", not \"" + law_ + "\"",
           "write: pair_style mdem/" + model_->law + " DIR, or export the scene anew");
  if (plain && !model_->interaction.terms.empty())
    refuse(lmp,
           "the scene has \"" + model_->interaction.terms.front()->name() + "\", which only the engine computes",
           "write: " + name + " DIR");
  engine_ = plain ? nullptr : std::make_unique<RankEngine>(lmp, model_);
  no_virial_fdotr_compute = engine_ ? 1 : 0;  // LAMMPS's forces then are those of bonds and damping as well
}

void PairMdem::coeff(int count, char**) {
  if (count != 2) refuse(lmp, "the scene has all coefficients of the contact", "write: pair_coeff * *");
  if (!allocated) allocate();
  for (int i = 1; i <= atom->ntypes; ++i)
    for (int j = i; j <= atom->ntypes; ++j) setflag[i][j] = 1;
}

void PairMdem::init_style() {
  check_atoms(lmp, "pair_style mdem");
  check_styles(lmp, *model_);
  // special_bonds leaves neighbours along a tube out of the list or keeps them; the model leaves them out itself.
  for (int bonds = 1; bonds <= 3; ++bonds) {
    const bool kept = force->special_lj[bonds] != 0;
    if (!kept && bonds > model_->topology.fewest_within(model_->interaction.excluded_arc()))
      refuse(lmp, "special_bonds leaves out elements of a tube that touch in this scene",
             "write: special_bonds lj/coul 1 1 1");
    if (kept && force->special_lj[bonds] != 1)
      refuse(lmp, "special_bonds weakens contact along a tube", "write only 0 or 1 behind special_bonds lj/coul");
  }
  if (!engine_) Pair::init_style();  // which asks for a list of pairs
  const bool mixed = model_->interaction.precision == Interaction::Precision::mixed;
  LMP::utils::logmesg(lmp, engine_ ? "Forces by the engine of the simulator, " + RankEngine::instructions() +
                                         ", in " + (mixed ? "mixed" : "double") + " precision\n"
                                   : std::string("Forces by the plain forms, pair by pair\n"));
}

double PairMdem::init_one(int, int) {
  return model_->interaction.has_contact() ? model_->interaction.cutoff()
                                           : copy_reach(model_->topology, model_->interaction, 0);
}

void PairMdem::contact(int i, int j) {
  const Vector3 separation = vector(atom->x[j]) - vector(atom->x[i]);
  if (!(separation.squaredNorm() < cutsq[1][1])) return;
  const Vector3 &n_i = axis_[static_cast<std::size_t>(i)], &n_j = axis_[static_cast<std::size_t>(j)];
  const Interaction& in = model_->interaction;
  const auto type = [&](int k) {
    return model_->topology.tube_type[model_->topology.tube_of(element_of(*atom, k))];
  };
  const TypePair types{type(i), type(j)};
  if (!in.law->reaches(types, separation, n_i, n_j)) return;
  const PairForce f = in.law->force(types, separation, n_i, n_j);
  energy_ += f.energy;
  add(atom->f[i], -f.force_j);
  add(atom->f[j], f.force_j);
  add(atom->torque[i], f.torque_i);
  add(atom->torque[j], f.torque_j);
  if (evflag)
    ev_tally_xyz(i, j, atom->nlocal, 1, f.energy, 0.0, f.force_j.x(), f.force_j.y(), f.force_j.z(), separation.x(),
                 separation.y(), separation.z());
}

void PairMdem::compute(int eflag, int vflag) {
  ev_init(eflag, vflag);
  if (engine_) {
    compute_by_engine(eflag);
  } else {
    compute_plain();
  }
}

void PairMdem::compute_by_engine(int eflag) {
  if (eflag_atom || vflag_atom || cvflag_atom)
    refuse(lmp, "the engine sums no energies or virials of single elements",
           "write: pair_style mdem/" + law_ + " DIR plain, or leave out computes of atoms");
  if (neighbor->ago == 0) engine_->build();
  engine_->compute(eflag != 0);
  if (eflag_global) eng_vdwl = engine_->contact_energy();
  if (vflag_global) {
    const std::array<double, 6> sum = engine_->virial(Parts::contact);
    std::copy(sum.begin(), sum.end(), virial);
  }
}

void PairMdem::compute_plain() {
  energy_ = 0;
  if (!model_->interaction.has_contact()) return;
  double** q = orientations(lmp);
  const int all = atom->nlocal + atom->nghost;
  axis_.resize(static_cast<std::size_t>(all));
  for (int i = 0; i < all; ++i) axis_[static_cast<std::size_t>(i)] = axis_of(quaternion(q[i]));
  for_contacts(lmp, *this, *model_, [&](int i, int j) { contact(i, j); });
  if (vflag_fdotr) virial_fdotr_compute();
}

}  // namespace ropewalk::lammps
