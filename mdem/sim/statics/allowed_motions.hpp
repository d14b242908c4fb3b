// Motions of a state that its constraints allow, without those that meet no stiffness.
//
// Constraints are projections of velocities that keep momentum, v -> P v (Load::constrain), so that P' = M P M^-1
// projects forces. Where a clamp turns, P turns with it: the forces r that the constraints bear then have a
// stiffness
//
//   G x = -P' (d/dx P') r,     r = f - P' f,
//
// such as that of a clamp whose elements press on it from all sides.
//
// A slice of an endless rope (TubeGroups::images) has other projections. Its energy U is that of one period, by the
// places of its own elements and, where it is free, by the period L. P moves images as their originals move and L
// grows. A force has its part on each own element, and that on L,
//
//   -dU/dL = sum s f_z / 2    over the images, s = 1 for the upper ones and -1 for the lower ones,
//
// which stands on the images and their originals so that a force times an allowed motion is the work. P' makes this
// of the forces on all elements. P' of such a force is not the force again.
//
// Moves of the whole, its turns and spins of single tubes are neutral where constraints allow them, and where
// neither loads nor terms feel them. They are taken out of motions and forces. A turn is taken out as well
// if the loads have no torque about its axis in any state, as couples of fixed direction at both ends have none
// about x and y. Each tilt of the rope then has its own state of rest, and the angular momentum of a motion stays
// zero. Without this the torques that spin tubes, which are taken out of the forces, leave a torque that tilts the
// rope without end.
//
// Units nm, ps, eV, rad; vectors have six numbers for each element.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "sim/dynamics/simulation.hpp"

namespace ropewalk {

class AllowedMotions {
 public:
  // The motions that are allowed at the present state of the simulation.
  explicit AllowedMotions(const Simulation& s);

  // Mass of each unknown; images have none.
  const Eigen::VectorXd& mass() const { return mass_; }
  // Adds `by` times the inertial forces of an allowed motion.
  void add_inertia(double by, const Eigen::VectorXd& x, Eigen::VectorXd& y) const;
  // For each unknown, whether the constraints hold it by itself.
  const std::vector<char>& held() const { return held_; }
  bool constrained() const { return constrained_; }

  void project_motion(Eigen::VectorXd& u) const;
  void project_force(Eigen::VectorXd& f) const;
  // Adds G x; `borne`: r.
  void add_constraint_stiffness(const Eigen::VectorXd& borne, const Eigen::VectorXd& x, Eigen::VectorXd& y) const;
  // Whether the constraints keep momentum. Those that act on different elements do.
  bool keeps_momentum() const { return keeps_momentum_; }
  // Whether P moves with the state.
  bool turns() const { return turns_; }
  // Whether the constraints tie each unknown to others.
  const std::vector<char>& tied() const { return tied_; }
  // Forces and motions under the constraints alone, motions without stiffness included.
  void constrain_motion(Eigen::VectorXd& u) const { constrain_motion(state_, u); }
  void constrain_force(Eigen::VectorXd& f) const { constrain_force(state_, f); }
  // Motions without stiffness: spins of single tubes, and orthonormal ones of the whole.
  std::vector<Eigen::VectorXd> spins() const;
  std::vector<Eigen::VectorXd> wholes() const;

  // A slice whose period is free: the force on the period (eV/nm) in a force as project_force() has it; that force
  // without it; and the motion that strains all by the same part, of unit growth of the period. Else: 0, the same,
  // empty.
  double force_on_period(const Eigen::VectorXd& f) const;
  Eigen::VectorXd without_period(const Eigen::VectorXd& f) const;
  Eigen::VectorXd stretch() const;
  // Takes the change of the period out of the motion.
  void let_period_stay(Eigen::VectorXd& u) const;

  // eV: the largest sum of the torques about its axis, of tubes whose spin is neutral.
  double largest_spin(const Eigen::VectorXd& force) const;
  // Which neutral motion a force works on, in words; empty: none. `force`: of the loads.
  std::string mechanism(const Eigen::VectorXd& force) const;

 private:
  void constrain_motion(const State& at, Eigen::VectorXd& u) const;
  void constrain_force(const State& at, Eigen::VectorXd& f) const;
  void find_constraints();
  void find_neutral(const Eigen::VectorXd& internal);
  void without_spins(Eigen::VectorXd& u, bool of_images) const;
  void find_images();
  double growth_of(const Eigen::VectorXd& u) const;
  void put_on_period(double force, Eigen::VectorXd& f) const;
  double spin_of(int tube, const Eigen::VectorXd& f) const;

  const Topology& topology_;
  const LoadsAndConstraints& loads_;
  State state_;
  mutable State scratch_;
  Eigen::VectorXd mass_;
  std::vector<char> held_, tied_;
  struct Image {
    Eigen::Index row = 0, original = 0;  // their first unknowns
    double sign = 1, part = 0;           // its part of the mass of all images
    Eigen::Matrix3d turn;                // rotation from the original
  };
  std::vector<Image> images_;
  bool free_period_ = false;
  bool constrained_ = false, turns_ = false, keeps_momentum_ = true;
  std::vector<Vector3> axis_;
  std::vector<char> spins_;  // of each tube: its spin is neutral
  struct Whole {
    Eigen::VectorXd motion, plain;  // orthonormal by the masses; as it was
    std::string words;
  };
  std::vector<Whole> whole_;
};

}  // namespace ropewalk
