// States of rest by Newton's method with a shift that falls (pseudo-transient continuation):
//
//   (K + s M) d = f,     state <- state moved by d
//
// with the tangent of stiffness.hpp. A large s is damped dynamics with short steps, s = 0 Newton's method. Where
// K + s M is not positive, s rises: a state that is no minimum is left along the motions that grow. No element goes
// farther than some tenths of its radius in a step, turns of whole sections of a rope apart; a step must lower the
// energy less the work of the loads, and s follows from how well the forces afterwards agree. C. T. Kelley,
// D. E. Keyes, SIAM J. Numer. Anal. 35, 508 (1998), DOI 10.1137/S0036142996304796.
//
// A state that rests is pushed once more: by conjugate gradients for random forces, which have a part in every
// motion. A motion of negative curvature that they meet is followed.
//
// FIRE goes first and between, where it is asked for: while contacts form, energies have no tangent worth a step.
//
// Units nm, ps, eV, rad.
#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <string>

#include "sim/dynamics/simulation.hpp"
#include "sim/statics/allowed_motions.hpp"
#include "sim/statics/solvers.hpp"
#include "sim/statics/stiffness.hpp"

namespace ropewalk {

struct NewtonOptions {
  bool fire = false;  // FIRE goes first, and again where Newton's steps are refused; not in a slice
  bool near = false;  // of rest: Newton's method goes first, with a smaller shift
  int most = 1000;    // steps of Newton's method; no state of rest that was met needed a fifth of them
  // Steps with a bond beyond its window, one after the other, after which it ends; 0: any number.
  int most_overloaded = 0;
  double farthest = 0.15;  // displacement of an element in a first try of a step, nm; turns count at the radius
  double first_rate = 3;   // 1/ps: s = rate^2 at the start; of slower chains than those of carbon all rates are less
  double least_rate = 3e-3;
  double slow = 3e-3;  // 1/ps: motions that grow more slowly do not count
  // ps: a saddle from which the energy falls alike to both sides is left to the one to which the loads of this time
  // would push; NaN: none are known.
  double loads_to_come = std::numeric_limits<double>::quiet_NaN();
};

// A wall that has collapsed bears no more, however long it is turned.
inline constexpr int enough_overloaded = 60;

// How a search for a state of rest ended.
struct Statics {
  enum class End {
    at_rest,
    out_of_steps,
    interrupted,
    refused  // no step is short enough for its forces to agree with the tangent
  };
  End end = End::out_of_steps;
  Relaxed relaxed;
  // eV/nm and eV: the largest force and torque on what is free, without what no stiffness meets.
  double largest_force = 0, largest_torque = 0;
  double spinning = 0;    // eV: the largest sum of the torques about its axis on a tube that nothing holds
  bool symmetric = true;  // loads and forces have a potential
  bool falls = false;     // at rest, a motion of negative curvature is known that was not followed any more
  int newton_steps = 0, refused = 0;
  long products = 0;
};

class NewtonStatics {
 public:
  explicit NewtonStatics(Simulation& simulation, const NewtonOptions& options = {});
  // Goes on where a relaxation with this goal is underway. Steps of both kinds count. After progress() has ended
  // it, it is still underway. Throws NumericalError where a bond slips, std::runtime_error for a term without
  // tangent.
  Statics relax(const RelaxGoal& goal, long max_steps, const std::function<bool(long)>& progress);
  // Takes the simulation to the time `until` (ps), on the way that constraints lead. It goes by steps in which the
  // rest of the rope follows to first order, and between which it comes near to rest. At the end it is not at rest
  // yet: relax() is. Ends with Statics::End::at_rest, ::interrupted or, where no step is short enough, ::refused.
  Statics follow(double until, const RelaxGoal& goal, const std::function<bool(long)>& progress);
  // Whether it is at Newton's method, and not at FIRE.
  bool at_newton() const { return at_newton_; }
  // Why it finds no state of rest, and what to do; empty: nothing speaks against it.
  struct Refusal {
    std::string why, remedy;
  };
  static Refusal refusal(const Simulation& simulation);

 private:
  struct At;  // what is known of the present state
  void look(At& at);
  bool is_slice() const { return s_.topology().groups.images > 0; }
  Solution solve(const At& at, double shift, const Eigen::VectorXd& b, double tolerance, Eigen::VectorXd& x);
  Statics come_near_rest(const std::function<bool(long)>& progress);
  bool follow_once(const At& at, double until);
  Eigen::VectorXd led(double passes) const;
  bool move(const Eigen::VectorXd& d, double passes = 0);
  struct SectionMove;
  std::vector<SectionMove> section_moves(const Eigen::VectorXd& d) const;
  Eigen::VectorXd on_arcs(const Eigen::VectorXd& d, Eigen::VectorXd& onward) const;
  double farthest(const Eigen::VectorXd& d, bool led_by_clamps = false) const;
  std::optional<Eigen::VectorXd> falling_motion(const At& at);
  bool push_along(const At& at, const Eigen::VectorXd& motion);
  double work_to_come(const At& at, const Eigen::VectorXd& d) const;

  Simulation& s_;
  NewtonOptions options_;
  StiffnessMaker maker_;
  Sections sections_;
  Statics out_;
  bool at_newton_ = true, roughly_ = false;
  Eigen::VectorXd onward_;  // the direction of the last move, at its end
};

}  // namespace ropewalk
