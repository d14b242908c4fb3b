#include "lammps/shared.hpp"

#include <map>
#include <numeric>

#include "bond.h"
#include "domain.h"
#include "lammps/bond_vbond.hpp"
#include "lammps/fix_damp.hpp"
#include "lammps/fix_grip.hpp"
#include "lammps/fix_motion.hpp"
#include "lammps/fix_states.hpp"
#include "lammps/pair_mdem.hpp"
#include "model/error.hpp"

namespace ropewalk::lammps {
namespace {

std::map<LMP::LAMMPS*, std::weak_ptr<const LammpsModel>>& models() {
  static std::map<LMP::LAMMPS*, std::weak_ptr<const LammpsModel>> all;
  return all;
}

std::shared_ptr<const LammpsModel> read_on_all_ranks(LMP::LAMMPS* lmp, const std::string& directory) {
  std::shared_ptr<const LammpsModel> model;
  std::string trouble;
  try {
    model = std::make_shared<LammpsModel>(load_lammps_model(directory));
  } catch (const std::exception& e) {
    trouble = e.what();
  }
  refuse_together(lmp, trouble);
  return model;
}

void check_boundary(LMP::LAMMPS* lmp) {
  for (int axis = 0; axis < 3; ++axis)
    for (int side = 0; side < 2; ++side) {
      const int kind = lmp->domain->boundary[axis][side];
      if (kind == 0) refuse(lmp, "the box is periodic, and ropes are free", "write: boundary m m m");
      if (kind == 1)
        refuse(lmp, "the box is fixed, and elements that leave it would be lost", "write: boundary m m m");
    }
}

}  // namespace

std::shared_ptr<const LammpsModel> load(LMP::LAMMPS* lmp, const std::string& directory) {
  auto model = models()[lmp].lock();
  if (!model || model->directory != directory) {
    model = read_on_all_ranks(lmp, directory);
    models()[lmp] = model;
  }
  return model;
}

std::shared_ptr<const LammpsModel> loaded(LMP::LAMMPS* lmp, const char* who) {
  auto model = models()[lmp].lock();
  if (!model)
    refuse(lmp, std::string(who) + " does not know the scene yet",
           "write pair_style mdem/... DIR or bond_style mdem/vbond DIR before it");
  return model;
}

void refuse(LMP::LAMMPS* lmp, const std::string& what, const std::string& remedy) {
  lmp->error->all(FLERR, what + "; " + remedy);
}

void refuse_one(LMP::LAMMPS* lmp, const std::string& what, const std::string& remedy) {
  lmp->error->one(FLERR, what + "; " + remedy);
}

void refuse_together(LMP::LAMMPS* lmp, std::string trouble) {
  int rank = 0, ranks = 1;
  MPI_Comm_rank(lmp->world, &rank);
  MPI_Comm_size(lmp->world, &ranks);
  int first = trouble.empty() ? ranks : rank, of_all = ranks;
  MPI_Allreduce(&first, &of_all, 1, MPI_INT, MPI_MIN, lmp->world);
  if (of_all == ranks) return;
  int length = static_cast<int>(trouble.size());
  MPI_Bcast(&length, 1, MPI_INT, of_all, lmp->world);
  trouble.resize(static_cast<std::size_t>(length));
  MPI_Bcast(trouble.data(), length, MPI_CHAR, of_all, lmp->world);
  lmp->error->all(FLERR, trouble + (of_all > 0 ? " (on rank " + std::to_string(of_all) + ")" : ""));
}

void check_atoms(LMP::LAMMPS* lmp, const char* who) {
  const LMP::Atom& atom = *lmp->atom;
  if (!atom.sphere_flag || !atom.omega_flag || !atom.torque_flag || !atom.rmass_flag || !atom.molecule_flag ||
      atom.avec == nullptr || atom.molecular != LMP::Atom::MOLECULAR)
    refuse(lmp, std::string(who) + " needs elements that turn and are bonded",
           "write: atom_style hybrid sphere bond");
  const LMP::Force& force = *lmp->force;
  if (force.ftm2v != 1 || force.mvv2e != 1)
    refuse(lmp, "units are not those of the model (nm, ps, eV, with factors 1)", "write: units lj");
  if (!force.newton_pair || !force.newton_bond)
    refuse(lmp, "forces on ghosts are not sent back to their owners", "write: newton on");
  if (!lmp->comm->ghost_velocity)
    refuse(lmp, "ghosts have no velocities, which damping needs", "write: comm_modify vel yes");
  check_boundary(lmp);
}

namespace {

// Each style acts once; a second one would double its forces.
template <class F>
void check_once(LMP::LAMMPS* lmp) {
  const LMP::Fix* first = nullptr;
  for (int k = 0; k < lmp->modify->nfix; ++k) {
    const LMP::Fix* fix = lmp->modify->fix[k];
    if (!dynamic_cast<const F*>(fix)) continue;
    if (first)
      refuse(lmp,
             std::string("fix ") + fix->style + " is there twice, as \"" + first->id + "\" and \"" + fix->id + "\"",
             std::string("leave one of them: unfix ") + fix->id);
    first = fix;
  }
}

}  // namespace

void check_styles(LMP::LAMMPS* lmp, const LammpsModel& model) {
  // Other integrators call other functions of a fix, or call them several times in a step.
  if (const char* style = lmp->update->integrate_style; style && std::string(style) != "verlet")
    refuse(lmp, std::string("run_style ") + style + " does not move elements as the model does",
           "write: run_style verlet");
  if (lmp->update->whichflag == 2)
    refuse(lmp, "a minimizer of LAMMPS turns no elements", "take fix motion all mdem/relax, and run");
  int motions = 0;
  for (int k = 0; k < lmp->modify->nfix; ++k) motions += lmp->modify->fix[k]->time_integrate != 0;
  if (!find_fix<FixMotion>(lmp))
    refuse(lmp, "nothing moves and turns the elements, or sends their orientations to other ranks",
           std::string("write: fix motion all mdem/") + (model.relax ? "relax" : "nve"));
  if (motions > 1)
    refuse(lmp, "more than one fix moves the elements", "leave only one of fix mdem/nve and fix mdem/relax");
  if (!dynamic_cast<BondVBond*>(lmp->force->bond))
    refuse(lmp, "elements of a tube are not bonded", "write: bond_style mdem/vbond DIR and bond_coeff *");
  check_once<FixGrip>(lmp);
  check_once<FixDamp>(lmp);
  check_once<FixStates>(lmp);
  const bool contact = dynamic_cast<PairMdem*>(lmp->force->pair) != nullptr;
  if (model.interaction.has_contact() && !contact)
    refuse(lmp, "the scene has contact, and there is none",
           std::string("write: pair_style mdem/") + model.law + " DIR");
  if (model.damped() && !find_fix<FixDamp>(lmp))
    refuse(lmp, "the scene has damping, and there is none", "write: fix damping all mdem/damp");
  if (model.driven() && !find_fix<FixGrip>(lmp))
    refuse(lmp, "the scene has loads, and there are none", "write: fix grips all mdem/grip");
}

namespace {

double** property(LMP::LAMMPS* lmp, const char* name, int wanted) {
  int is_double = 0, columns = 0;
  const int index = lmp->atom->find_custom(name, is_double, columns);
  if (index < 0 || !is_double || columns != wanted)
    refuse(lmp, "elements have no orientations, or do not carry their forces from run to run",
           "write: fix elements all property/atom d2_quat 4 d2_carried 6 ghost yes, before read_data or after "
           "read_restart");
  return lmp->atom->darray[index];
}

}  // namespace

double** orientations(LMP::LAMMPS* lmp) { return property(lmp, "quat", 4); }
double** carried(LMP::LAMMPS* lmp) { return property(lmp, "carried", 6); }

void RankMessages::sum(double* values, std::size_t count) const {
  MPI_Allreduce(MPI_IN_PLACE, values, static_cast<int>(count), MPI_DOUBLE, MPI_SUM, world_);
}
std::vector<int> RankMessages::join(const std::vector<int>& own) const {
  int ranks = 1;
  MPI_Comm_size(world_, &ranks);
  const int count = static_cast<int>(own.size());
  std::vector<int> counts(static_cast<std::size_t>(ranks)), at(counts.size());
  MPI_Allgather(&count, 1, MPI_INT, counts.data(), 1, MPI_INT, world_);
  std::partial_sum(counts.begin(), counts.end() - 1, at.begin() + 1);
  std::vector<int> all(static_cast<std::size_t>(counts.back() + at.back()));
  MPI_Allgatherv(own.data(), count, MPI_INT, all.data(), counts.data(), at.data(), MPI_INT, world_);
  return all;
}

std::vector<double> on_first_rank(LMP::LAMMPS* lmp, const std::vector<double>& own) {
  const auto ranks = static_cast<std::size_t>(lmp->comm->me == 0 ? lmp->comm->nprocs : 0);
  const int count = static_cast<int>(own.size());
  std::vector<int> counts(ranks), at(ranks);
  MPI_Gather(&count, 1, MPI_INT, counts.data(), 1, MPI_INT, 0, lmp->world);
  if (ranks > 0) std::partial_sum(counts.begin(), counts.end() - 1, at.begin() + 1);
  std::vector<double> all(ranks > 0 ? static_cast<std::size_t>(counts.back() + at.back()) : 0);
  MPI_Gatherv(own.data(), count, MPI_DOUBLE, all.data(), counts.data(), at.data(), MPI_DOUBLE, 0, lmp->world);
  return all;
}

double sum_over_ranks(LMP::LAMMPS* lmp, double value) {
  double sum = 0;
  MPI_Allreduce(&value, &sum, 1, MPI_DOUBLE, MPI_SUM, lmp->world);
  return sum;
}

}  // namespace ropewalk::lammps
