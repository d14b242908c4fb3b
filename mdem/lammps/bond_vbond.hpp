// bond_style mdem/vbond DIR: the bonds of the scene in DIR, with the energy of mdem/model/bond.hpp.
#pragma once

#include "bond.h"
#include "lammps/rank_engine.hpp"

namespace ropewalk::lammps {

class BondVBond : public LMP::Bond {
 public:
  explicit BondVBond(LMP::LAMMPS* lmp) : Bond(lmp) {}
  ~BondVBond() override;
  void settings(int count, char** words) override;
  void coeff(int count, char** words) override;
  void init_style() override;
  void compute(int eflag, int vflag) override;
  double equilibrium_distance(int type) override;
  // Restart files need no coefficients: the scene has them.
  void write_restart(FILE*) override {}
  void read_restart(FILE*) override {}
  double single(int type, double rsq, int i, int j, double& fforce) override;

  // Refuses a bond that is about to slip where no rank can go back.
  void check_slip(const RankEngine& engine) const;
  const BondEnergy& own_energy() const { return sum_; }  // energy of this rank's bonds in the last evaluation

 private:
  BondForce evaluate(int i, int j, const Vector3& separation) const;
  void report(RankEngine& engine);
  [[noreturn]] void refuse_slip(int element) const;
  void apply(int i, int j);
  void tally(int i, int j, const BondForce& f, const Vector3& separation);

  std::shared_ptr<const LammpsModel> model_;
  double** orientations_ = nullptr;  // valid during a call only
  BondEnergy sum_;
};

// Calls f(i, j) for every bond of this rank, i being the lower element.
template <class F>
void for_bonds(const LMP::Atom& atom, int** bonds, int count, F f) {
  for (int n = 0; n < count; ++n) {
    const int a = bonds[n][0], b = bonds[n][1];
    if (atom.tag[a] < atom.tag[b]) {
      f(a, b);
    } else {
      f(b, a);
    }
  }
}

}  // namespace ropewalk::lammps
