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
// Moves of the whole, its turns and spins of single tubes are neutral where constraints allow them, and where
// neither loads nor terms feel them. They are taken out of motions and forces.
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
  // At the state of the simulation.
  explicit AllowedMotions(const Simulation& s);

  const Eigen::VectorXd& mass() const { return mass_; }
  // For each unknown, whether the constraints hold it by itself.
  const std::vector<char>& held() const { return held_; }
  bool constrained() const { return constrained_; }

  void project_motion(Eigen::VectorXd& u) const;
  void project_force(Eigen::VectorXd& f) const;
  // Adds G x; `borne`: r.
  void add_constraint_stiffness(const Eigen::VectorXd& borne, const Eigen::VectorXd& x, Eigen::VectorXd& y) const;
  // Whether they keep momentum, as those do that act on different elements.
  bool keeps_momentum() const { return keeps_momentum_; }
  // Whether P moves with the state.
  bool turns() const { return turns_; }

  // eV: the largest sum of the torques about its axis, of tubes whose spin is neutral.
  double largest_spin(const Eigen::VectorXd& force) const;
  // Which neutral motion a force works on, in words; empty: none. `force`: of the loads.
  std::string mechanism(const Eigen::VectorXd& force) const;

 private:
  void constrain_motion(const State& at, Eigen::VectorXd& u) const;
  void constrain_force(const State& at, Eigen::VectorXd& f) const;
  void find_constraints();
  void find_neutral(const Eigen::VectorXd& internal);
  void without_spins(Eigen::VectorXd& u) const;
  double spin_of(int tube, const Eigen::VectorXd& f) const;

  const Topology& topology_;
  const LoadsAndConstraints& loads_;
  State state_;
  mutable State scratch_;
  Eigen::VectorXd mass_;
  std::vector<char> held_;
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
