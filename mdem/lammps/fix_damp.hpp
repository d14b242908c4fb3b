// fix ID all mdem/damp: the dampings of the scene, with the forms of mdem/model/damping.hpp. Contact viscosity and
// bond damping act on pairs, ghosts included, before forces on ghosts are sent back; PFC local damping acts in the
// kick of fix mdem/nve, once this fix is there.
#pragma once

#include "lammps/shared.hpp"

namespace ropewalk::lammps {

class FixDamp : public LMP::Fix {
 public:
  FixDamp(LMP::LAMMPS* lmp, int count, char** words);
  int setmask() override { return LMP::FixConst::PRE_REVERSE; }
  void setup_pre_reverse(int eflag, int vflag) override { pre_reverse(eflag, vflag); }
  void pre_reverse(int eflag, int vflag) override;

  double own_power() const { return power_; }  // power of this rank's pairs and bonds in the last evaluation, eV/ps
  double local() const { return model_->interaction.damping.local; }

 private:
  void apply(const DampingForce& d, int i, int j);
  void contacts();
  void bonds();

  std::shared_ptr<const LammpsModel> model_;
  double power_ = 0;
};

}  // namespace ropewalk::lammps
