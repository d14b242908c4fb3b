// Dynamics of a scene: velocity Verlet for positions and orientations, with an energy account.
//
//   v += F dt/2m,  w += M dt/2I;   x += v dt,  q <- exp(w dt) q;   forces;   v += F dt/2m,  w += M dt/2I
//
// With isotropic inertia w is constant between kicks and the rotation is exact, so the scheme is the
// symplectic kick-drift-kick splitting, time reversible and of second order. Damping forces use the half-step
// velocities.
//
// On two levels (Stepping::contact_every = n > 1) the contact and its viscosity act as impulses at both ends of an
// outer step, and n such steps of dt/n with bonds, loads and constraints alone lie between them. Still symplectic
// where nothing is damped. Where one step of the simulation is meant below, it is an outer one.
// M. Tuckerman, B. J. Berne, G. J. Martyna, J. Chem. Phys. 97, 1990 (1992), DOI 10.1063/1.463137.
//
// Account: total energy - work of loads + energy dissipated is constant up to integration error.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "sim/dynamics/free_and_driven.hpp"
#include "sim/dynamics/loads.hpp"
#include "sim/dynamics/step_limit.hpp"
#include "sim/dynamics/stepping.hpp"
#include "sim/forces/forces.hpp"
#include "sim/neighbours/neighbours.hpp"
#include "sim/state/interaction.hpp"
#include "sim/state/state.hpp"

namespace ropewalk {

// Parts of the limit that are used when the step is not typed. A cold rope hardly moves in the waves that set the
// limit: its energies are the same to 4 digits with either step. Heat is in all of them: at 300 K, without damping,
// the account of energy is off by 6 % of the kinetic energy in the first picosecond with 0.6, by 20 % with 0.9 (and
// stays there). Relaxation and two levels have bounds of their own.
inline constexpr double default_step_fraction = 0.6;
inline constexpr double cold_step_fraction = 0.9;

// nm, of the first list; what costs least is found as the run goes where contact is by the line law. Its runs skip
// what is out of reach, so that a wide margin costs little.
inline double default_skin(const Interaction& in) { return in.line.empty() ? 0.15 : 0.25; }

class Simulation {
 public:
  // time_step: by how much a step takes time forward. skin: of all lists; 0: chosen here.
  Simulation(Topology topology, Interaction interaction, LoadsAndConstraints loads, State state, double time_step,
             double skin = 0, Stepping stepping = {});

  // Without `energies` the contact energy may be NaN afterwards, and with it the total one: they cost a tenth of a
  // step. The motion is the same bits.
  void step(bool energies = true) { steps(1, energies); }
  // So many steps, with energies in the last one: the same bits as one by one, and faster, as the kick that ends a
  // step and that which begins the next are made while its elements are moved.
  void steps(long count, bool energies = true);
  // Relaxes orientations and positions to a nearby minimum (FIRE). Returns whether the largest force
  // (eV/nm) and torque over radius fell below the tolerance within the given steps.
  bool relax(double force_tolerance, long max_steps, const std::function<bool(long)>& progress);

  const Topology& topology() const { return topology_; }
  const Interaction& interaction() const { return interaction_; }
  const LoadsAndConstraints& loads() const { return loads_; }
  const State& state() const { return state_; }
  const Forces& forces() const { return forces_; }
  const NeighbourList& list() const { return list_; }
  const ForceEngine& engine() const { return engine_; }
  double time_step() const { return time_step_; }
  const Stepping& stepping() const { return stepping_; }
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
  bool two_levels() const { return stepping_.contact_every > 1; }
  double inner_step() const { return time_step_ / stepping_.contact_every; }
  void one_level(long step, long count, bool energies);
  void two_level(bool energies);
  bool kicks_while_moving() const;
  void compute_contact_in_impulse(bool energies);
  void kick(const Forces& forces, double dt);
  void kick_with_loads(const Forces& forces, double dt);
  double kick_tube(const Forces& forces, int tube, double dt);
  void kick_range(const ForcesOn& forces, const ElementRange& of, double dt);
  void kick_driven(int kicks, double dt);
  // How far elements have come since the list was built, if looked for, how fast they are, and whether the last
  // drift was a small one.
  struct Moved {
    Change change;
    double speed2 = 0, spin2 = 0;
    bool little = true, looked = true;
  };
  // What a drift does to elements: after so many kicks of half a step, and whether it makes their axes and looks
  // how far they have come.
  struct Drift {
    double dt;
    int kicks;
    bool axes, looks;
  };
  Moved all_moved() const;
  void look();
  void drift_range(const ElementRange& of, const ForcesOn& forces, const Drift& by, Moved& moved);
  void drift_block(int block, const ForcesOn& forces, const Drift& by);
  void drift_driven(const Drift& by);
  void drift_free(const Drift& by);
  void drift(const Drift& by);
  void update_list(Moved all);
  void compute(bool energies = true, bool axes_made = false, const Drift* then = nullptr);
  void keep_on_driven(int block, const ForcesOn& forces);
  void compute_bonds();
  void compute_contact(bool energies);
  void add_loads(Forces& forces);
  void add_levels();
  void check_motion(const Moved& all) const;
  void check_forces(bool energies) const;
  void relax_angles_if_due();

  Topology topology_;
  Interaction interaction_;
  LoadsAndConstraints loads_;
  State state_;
  double time_step_ = 0;
  Stepping stepping_;
  FreeAndDriven elements_;  // driven: by loads or constraints
  bool tunes_skin_ = false;
  NeighbourList list_;
  std::int64_t list_age_ = 0;  // steps since the list was built
  std::vector<Moved> moved_;   // of the blocks, and behind them of what is driven
  MotionSince::Bound unseen_;  // since the places were last looked at
  bool looks_ = true;          // whether the next drift does
  ForceEngine engine_;
  Forces forces_;           // of all
  Forces inner_, contact_;  // its two parts, on two levels: bonds and loads; contact
  std::vector<PointLoad> point_loads_;
  std::vector<double> removed_;  // by the local damping, of each tube
  double work_ = 0, dissipated_ = 0;
  double list_seconds_ = 0, integration_seconds_ = 0;
};

}  // namespace ropewalk
