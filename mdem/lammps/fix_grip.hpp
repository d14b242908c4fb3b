// fix ID all mdem/grip: all loads and constraints of the scene (twisting moments on the grips, fixed and loaded
// elements, prescribed rotations), with the functions of mdem/sim/dynamics/loads.hpp. These take a State; this fix
// makes one of this rank's driven elements. Sums over a grip that several ranks share are a few numbers in a
// message.
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
  // The loads of the present state, for the work of the next kick.
  void find_loads();
  void post_force(int vflag) override;

  // Atoms of the elements that it acts on, on this rank.
  const std::vector<int>& atoms() const { return atom_; }
  // Work per time of the loads on this rank's elements, eV/ps.
  double own_power();
  // Sets constrained velocities after a kick by the present forces, for a drift that lasts twice `ahead` (ps).
  // Returns this rank's share of the work, eV.
  double constrain(double time, double ahead, double kick);
  // Sets the constrained components of `linear` and `angular` to zero; both are arrays like v and omega.
  void free_parts(double time, double** linear, double** angular);

 private:
  // An element that a load acts on.
  struct Place {
    int element;
    int load;           // index in the scene's loads
    std::size_t place;  // in Load::elements
    bool operator<(const Place& o) const { return element < o.element; }
  };
  RankEngine* leading_engine() const;
  void gather(bool those_of_others);
  void ask_others();

  std::shared_ptr<const LammpsModel> model_;
  RankMessages ranks_;
  std::vector<Place> places_;  // places of all loads, sorted by elements
  // Elements of loads that read others (Load::reads), which every rank knows: numbers in the scene, in rising order,
  // and their places in the state below. Images of a slice and their originals are found alike.
  std::vector<int> known_, known_at_;
  std::vector<std::vector<int>> reads_;  // elements that each load reads
  std::vector<double> numbers_;          // message to all ranks
  // The scene of this rank's driven elements: its element k is atom atom_[k]; -1: another rank has it.
  std::vector<int> atom_;
  Topology topology_;
  LoadsAndConstraints acting_;
  State state_;
  Forces forces_;
  std::vector<int> own_;                     // elements of this state that are this rank's
  std::vector<ConstraintImpulse> impulses_;  // impulses of the last kick
  std::vector<PointLoad> loads_;             // loads of the last evaluation
};

}  // namespace ropewalk::lammps
