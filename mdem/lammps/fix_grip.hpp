// fix ID all mdem/grip: all loads and constraints of the scene (twisting moments on the grips, fixed and loaded
// elements, prescribed rotations), with the functions of mdem/sim/dynamics/loads.hpp. These take a State; this fix
// makes one of the driven elements: those of this rank, or all of them if a load needs the whole grip.
#pragma once

#include "lammps/shared.hpp"

namespace ropewalk::lammps {

class RankEngine;

class FixGrip : public LMP::Fix {
 public:
  FixGrip(LMP::LAMMPS* lmp, int count, char** words);
  int setmask() override { return LMP::FixConst::POST_FORCE | LMP::FixConst::POST_NEIGHBOR; }
  void setup_post_neighbor() override { post_neighbor(); }
  void post_neighbor() override;
  void setup(int vflag) override { post_force(vflag); }
  void post_force(int vflag) override;

  // Of the elements that it acts on, on this rank; -1: on another one.
  const std::vector<int>& atoms() const { return atom_; }
  // Work per time of the loads on this rank's elements, eV/ps.
  double own_power();
  // Sets constrained velocities after a kick by the present forces. The kick lasts half as long as the drift.
  // Returns this rank's share of the work, eV.
  double constrain(double time, double kick);
  // Sets the constrained components of `linear` and `angular` to zero; both are arrays like v and omega.
  void free_parts(double time, double** linear, double** angular);

 private:
  RankEngine* leading_engine() const;
  void use(const std::vector<int>& elements);
  void gather();
  void share(const std::vector<std::vector<double>*>& all);
  bool owned(std::size_t k) const { return atom_[k] >= 0; }

  std::shared_ptr<const LammpsModel> model_;
  std::vector<int> driven_;  // elements, sorted
  bool whole_ = false;       // the state holds all driven elements on every rank
  // The scene of the driven elements: its element k is atom atom_[k] of this rank; -1: an atom of another rank.
  std::vector<int> atom_;
  Topology topology_;
  LoadsAndConstraints acting_;
  State state_;
  Forces forces_;
  std::vector<int> own_;                     // all elements of this state
  std::vector<double> shared_;
  std::vector<ConstraintImpulse> impulses_;  // of the last kick
  std::vector<PointLoad> loads_;             // of the last evaluation, on this rank's elements
};

}  // namespace ropewalk::lammps
