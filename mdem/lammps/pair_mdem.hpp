// pair_style mdem/paper DIR [plain], mdem/line DIR [plain], mdem/none DIR [plain]: the contact law of the scene in
// DIR; none has tubes that do not touch. The simulator's engine computes all forces of the model at once, those of bonds and damping as well. With `plain`, pair by pair,
// the forms of mdem/model do: slowly, for comparison, and for energies and virials of atoms.
#pragma once

#include "lammps/rank_engine.hpp"
#include "neigh_list.h"
#include "pair.h"

namespace ropewalk::lammps {

class PairMdem : public LMP::Pair {
 public:
  PairMdem(LMP::LAMMPS* lmp, std::string law);
  ~PairMdem() override;
  void settings(int count, char** words) override;
  void coeff(int count, char** words) override;
  void init_style() override;
  double init_one(int i, int j) override;
  void compute(int eflag, int vflag) override;

  // Energy of this rank's pairs in the last evaluation, eV.
  double own_energy() const { return engine_ ? engine_->contact_energy() : energy_; }
  RankEngine* engine() const { return engine_.get(); }

 private:
  void allocate();
  void compute_plain();
  void compute_by_engine(int eflag);
  void contact(int i, int j);

  std::string law_;
  std::shared_ptr<const LammpsModel> model_;
  std::unique_ptr<RankEngine> engine_;  // none: plain
  std::vector<Vector3> axis_;           // axes of own and ghost elements
  double energy_ = 0;
};

// The engine in use, or null.
inline RankEngine* engine_of(LMP::LAMMPS* lmp) {
  const auto* pair = dynamic_cast<const PairMdem*>(lmp->force->pair);
  return pair ? pair->engine() : nullptr;
}

// Calls f(i, j) for every pair of the half list of `pair` that interacts, i being the lower element, and both as
// indices of atoms.
template <class F>
void for_contacts(LMP::LAMMPS* lmp, const LMP::Pair& pair, const LammpsModel& model, F f) {
  const LMP::Atom& atom = *lmp->atom;
  const LMP::NeighList& list = *pair.list;
  for (int k = 0; k < list.inum; ++k) {
    const int a = list.ilist[k];
    for (int n = 0; n < list.numneigh[a]; ++n) {
      const int b = list.firstneigh[a][n] & NEIGHMASK;
      const int i = atom.tag[a] < atom.tag[b] ? a : b, j = i == a ? b : a;
      if (atom.molecule[i] == atom.molecule[j] &&
          atom.tag[j] - atom.tag[i] <= type_of(model, atom, i).elements_within(model.interaction.excluded_arc()))
        continue;
      f(i, j);
    }
  }
}

}  // namespace ropewalk::lammps
