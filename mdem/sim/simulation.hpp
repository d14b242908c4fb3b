// Dynamics of a scene: velocity Verlet for positions and orientations, with an energy account.
//
//   v += F dt/2m,  w += M dt/2I;   x += v dt,  q <- exp(w dt) q;   forces;   v += F dt/2m,  w += M dt/2I
//
// With isotropic inertia w is constant between kicks and the rotation is exact, so the scheme is the
// symplectic kick-drift-kick splitting, time reversible and of second order. Damping forces use the half-step
// velocities.
//
// Account: total energy - work of loads + energy dissipated is constant up to integration error.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "sim/drive.hpp"
#include "sim/forces.hpp"
#include "sim/interaction.hpp"
#include "sim/neighbours.hpp"
#include "sim/state.hpp"

namespace ropewalk {

// Stability limit of the time step (ps): the stiffest mode of a straight chain, the contact in a compressed
// hexagonal rope and the strongest explicit damping together,
//   w^2 dt^2 + 2 g dt = 4,   w^2 = w_chain^2 + w_contact^2.
struct TimeStepLimit {
  double limit = 0;              // ps
  double chain_frequency = 0;    // rad/ps
  double contact_frequency = 0;  // rad/ps
  double damping_rate = 0;       // 1/ps
};
TimeStepLimit time_step_limit(const Topology& topology, const Interaction& interaction, double spacing);

// Part of the limit that is used when the step is not typed.
inline constexpr double default_step_fraction = 0.6;

// nm. The runs of the line law skip what is out of reach, so that a wide margin costs little.
inline double default_skin(const Interaction& in) { return in.line.empty() ? 0.15 : 0.25; }

class Simulation {
 public:
  Simulation(Topology topology, Interaction interaction, Drive drive, State state, double time_step,
             double skin = 0);  // 0: the default

  // Without `energies` the contact energy may be NaN afterwards, and with it the total one: they cost a tenth of a
  // step. The motion is the same bits.
  void step(bool energies = true);
  // Relaxes orientations and positions to a nearby minimum (FIRE). Returns whether the largest force
  // (eV/nm) and torque over radius fell below the tolerance within the given steps.
  bool relax(double force_tolerance, long max_steps, const std::function<bool(long)>& progress);

  const Topology& topology() const { return topology_; }
  const Interaction& interaction() const { return interaction_; }
  const Drive& drive() const { return drive_; }
  const State& state() const { return state_; }
  const Forces& forces() const { return forces_; }
  const NeighbourList& list() const { return list_; }
  const ForceEngine& engine() const { return engine_; }
  double time_step() const { return time_step_; }
  double work() const { return work_; }
  double dissipated() const { return dissipated_; }
  double list_seconds() const { return list_seconds_; }
  double integration_seconds() const { return integration_seconds_; }
  double total_energy() const { return forces_.energy.potential() + kinetic_energy(topology_, state_); }
  // Largest force in eV/nm, torques counted as torque over radius; constrained components left out.
  double largest_force() const;
  std::size_t bytes() const;

  // Everything that the future depends on, as bytes, and back. restore throws std::runtime_error where the
  // bytes do not belong to this scene.
  std::string serialise() const;
  void restore(const std::string& bytes);
  // Goes on with a run that another engine has carried on: its last total forces and its account of energy.
  void take_over(const Vec3Array& force, const Vec3Array& torque, double work, double dissipated) {
    forces_.force = force;
    forces_.torque = torque;
    work_ = work;
    dissipated_ = dissipated;
  }

 private:
  void kick(double dt);
  double kick_tube(int tube, double dt);
  void drift(double dt);
  void compute(bool energies = true);
  void check(bool energies) const;
  void relax_angles_if_due();

  Topology topology_;
  Interaction interaction_;
  Drive drive_;
  State state_;
  double time_step_ = 0;
  NeighbourList list_;
  ForceEngine engine_;
  Forces forces_;
  std::vector<PointLoad> point_loads_;
  std::vector<double> removed_;  // by the local damping, of each tube
  double work_ = 0, dissipated_ = 0;
  double list_seconds_ = 0, integration_seconds_ = 0;
};

}  // namespace ropewalk
