// Dynamics of a scene: steps of velocity Verlet (sim/dynamics/verlet.hpp) with an account of the energy that comes
// in and goes out; relaxation; checkpoints.
//
// total energy - account().supplied() is constant up to the error of the integration.
#pragma once

#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "model/contract.hpp"
#include "sim/dynamics/energy_supply.hpp"
#include "sim/dynamics/gauges.hpp"
#include "sim/dynamics/loads.hpp"
#include "sim/dynamics/relax_goal.hpp"
#include "sim/dynamics/step_limit.hpp"
#include "sim/dynamics/stepping.hpp"
#include "sim/forces/forces.hpp"
#include "sim/neighbours/neighbours.hpp"
#include "sim/state/interaction.hpp"
#include "sim/state/state.hpp"
#include "sim/state/tiles.hpp"

namespace ropewalk {

class DeviceStepper;
struct MotionBound;

// Parts of the limit that are used when the step is not typed. A cold rope hardly moves in the waves that set the
// limit: its energies are the same to 4 digits with either step. Heat is in all of them: at 300 K, without damping,
// the account of energy is off by 6 % of the kinetic energy in the first picosecond with 0.6, by 20 % with 0.9 (and
// stays there). Relaxation has bounds of its own.
inline constexpr double default_step_fraction = 0.6;
inline constexpr double cold_step_fraction = 0.9;

// Skin of the first list, nm; the engine of a law may find a better one during the run.
inline double default_skin(const Interaction& in) { return in.law ? in.law->default_skin() : 0.15; }

class Simulation {
 public:
  // time_step: by how much a step takes time forward. skin: of all lists; 0: chosen here.
  Simulation(Topology topology, Interaction interaction, LoadsAndConstraints loads, State state, double time_step,
             double skin = 0, Stepping stepping = {});

  // Without `energies` the contact energy may be NaN afterwards, and with it the total one: they cost a tenth of a
  // step. The motion is the same bits.
  void step(bool energies = true) { steps(1, energies); }
  // Advances `count` steps; energies in the last. Bitwise equal to `count` calls of step().
  void steps(long count, bool energies = true);
  // Relaxes orientations and positions to a nearby minimum of the energy (FIRE). Returns whether largest_force()
  // fell below the tolerance (eV/nm) within the given steps. `progress` is called in every step; false ends the
  // relaxation. The account has the work of the loads, and as dissipated what the relaxation takes out.
  bool relax(double force_tolerance, long max_steps, const std::function<bool(long)>& progress);
  // Goes on until the energy is near that of the minimum as well. After progress() has ended it, it is still
  // underway: with the same goal the next call goes on as if nothing had happened, also from a checkpoint. Steps
  // are counted from its begin.
  Relaxed relax(const RelaxGoal& goal, long max_steps, const std::function<bool(long)>& progress);
  // For the solvers of sim/statics: the relaxation with this goal, which begins or goes on; steps of FIRE in it,
  // until no force is larger (eV/nm), up to the step `most` of the relaxation; and one step by which every element
  // goes, as far as the constraints let it, along a displacement and a turn (nm, rad). In such a step time may go
  // on by `passes` (ps): loads have their later values, and constraints go as far as their schedules do.
  NewtonPace& relaxation_with(const RelaxGoal& goal);
  bool relax_by_fire(double force, long most, const std::function<bool(long)>& progress);
  void displace(const Vec3Array& displacement, const Vec3Array& turn, double passes = 0);
  // Ends the relaxation, and remembers where it came to rest.
  void rest_after(const Relaxed& end);
  const Rest& last_rest() const { return rest_; }
  // Everything stands still where the relaxation that is underway has come to. steps() begins with it.
  void end_relaxation();
  std::int64_t relaxation_began() const { return relaxation_.underway() ? relaxation_.began : state_.step; }

  const Topology& topology() const { return topology_; }
  const Interaction& interaction() const { return interaction_; }
  const LoadsAndConstraints& loads() const { return loads_; }
  const State& state() const { return download(), state_; }
  const Forces& forces() const { return download(), forces_; }
  // Time and step of state(), without a copy of the state from a device.
  double time() const { return state_.time; }
  std::int64_t step_count() const { return state_.step; }
  const NeighbourList& list() const;
  const ForceEngine& engine() const { return engine_; }
  double time_step() const { return time_step_; }
  // From now on each step is `parts` shorter ones. Steps are counted as before.
  void divide_steps(int parts) {
    ROPEWALK_EXPECTS(parts > 0);
    divided_ = parts;
  }
  int divided() const { return divided_; }
  const Stepping& stepping() const { return stepping_; }
  const EnergySupply& account() const { return account_; }
  double work() const { return account_.work; }
  double dissipated() const { return account_.dissipated; }
  double heat() const { return account_.heat; }
  double list_seconds() const { return list_seconds_; }
  double integration_seconds() const { return integration_seconds_; }
  // From now on these loads and constraints act. Those that set velocities do so from the next kick on, and their
  // work there counts. The gauges stay on their elements.
  void use_loads(LoadsAndConstraints loads);
  // The thermostat acts from the next step on; none: no bath. Its heat so far stays in the account. Its internal
  // variables keep their values where the new one has as many as the old, as where only the temperature changes.
  void use_thermostat(std::shared_ptr<const Thermostat> thermostat);
  // A device moves the elements that no load acts on, from the next step on. open_device() knows the names of
  // devices. The simulation itself still computes the energies, when a caller asks for them. Throws
  // std::invalid_argument where there is no such device, or where the device cannot compute the scene.
  void use_device(const std::string& name);
  const DeviceStepper* device() const { return device_.stepper.get(); }
  // On these elements, before the first step; without it they are the ends of all tubes. Turns count from `start`.
  void set_gauges(EndElements ends, const State& start) {
    sync_to_host();
    gauges_ = Gauges(topology_, std::move(ends), start);
  }
  // Mean forces and torques at both ends since the last reading; those of this moment where no time has passed.
  EndReadings read_gauges();
  double total_energy() const {
    download();
    return forces_.energy.potential() + kinetic_energy(topology_, state_);
  }
  // Largest force in eV/nm, torques counted as torque over radius; constrained components left out.
  double largest_force() const;
  std::size_t bytes() const;

  // Everything that the future depends on, as bytes, and back. restore throws std::runtime_error where the
  // bytes do not belong to this scene.
  std::string serialise() const;
  void restore(const std::string& bytes);
  // Goes on with a run that another engine has carried on: its last total forces and its account of energy.
  void inherit_from(const Vec3Array& force, const Vec3Array& torque, const EnergySupply& account) {
    ROPEWALK_EXPECTS(force.size() == state_.size() && torque.size() == state_.size());
    sync_to_host();
    forces_.force = force;
    forces_.torque = torque;
    account_ = account;
  }
  void inherit_from(const Gauges::Sums& sums) { gauges_.sums = sums; }
  // The internal variables of the thermostat; empty where it has none.
  const std::vector<double>& thermostat_variables() const { return thermostat_variables_; }
  // What each of the interaction's terms has done since the start.
  std::vector<TermAccount> term_accounts() const { return engine_.terms().accounts(); }
  // The tubes as they are now: cut where they have broken.
  Topology tubes_now() const {
    const std::vector<char>* broken = engine_.terms().broken_bonds();
    return broken ? cut_behind(topology_, *broken) : topology_;
  }
  const std::vector<char>* broken_bonds() const { return engine_.terms().broken_bonds(); }
  std::vector<NamedMemory> term_memories() const { return engine_.terms().memories(); }
  // What has happened since the start or since forget_events(), in the order of time. A checkpoint has none of them.
  std::vector<TermEvent> term_events() const { return engine_.terms().events(); }
  void forget_events() { engine_.forget_events(); }
  // The memories of all force terms, ForceTerms::memory(), and a simulation that goes on with such ones: its forces
  // and energies are those of the present state.
  std::vector<double> memory() const { return engine_.terms().memory(); }
  void set_memory(const std::vector<double>& memory);
  // The memories of all force terms for the same rope on the finer chain; `heirs`: see sim/dynamics/refine.hpp.
  std::vector<double> halved_memory(const std::vector<int>& heirs) const {
    return engine_.terms().halved_memory(heirs);
  }
  // As of an engine of its own, with all energies; in the precision that is asked for, without the loads.
  Forces forces_at(const State& state, Interaction::Precision precision) const;
  const Gauges& gauges() const { return gauges_; }

 private:
  struct System;  // that of sim/dynamics/verlet.hpp

  double part_step() const { return time_step_ / divided_; }
  void step_once(bool energies);
  // download() copies the newest state and forces from the device. After sync_to_host() this processor moves all
  // elements, until upload() gives them to the device again.
  void download() const;
  void sync_to_host();
  void upload();
  void compute_on_device();
  [[noreturn]] void refuse_blow_up(const MotionBound& bound) const;
  void kick(double dt);
  void drift(double dt);
  void move(double dt);
  void bathe(double dt);
  void update_list();
  void compute(bool energies = true, std::optional<double> passed = {});
  void add_point_loads();
  void check_forces(bool energies) const;
  void check_slip() const;
  void relax_spins_if_due();
  double engine_seconds() const;
  void begin_relaxation(const RelaxGoal& goal);
  enum class PartEnd { small_forces, out_of_steps, interrupted };
  PartEnd relax_part(long max_steps, const std::function<bool(long)>& progress);
  void balance_relaxation();
  void stand_still();
  void move_in_relaxation(double step);
  struct Motion;
  class Stiffness;
  double farthest(const Motion& motion) const;  // largest displacement, nm; turns count at the largest radius
  Motion free_accelerations(const Motion& forces) const;
  double above_minimum(double enough, long most) const;
  std::optional<std::pair<Motion, double>> falling_motion(long most) const;
  template <class Archive, class Self, class ListAndMemories>
  static void visit_checkpoint(Archive& archive, Self& self, ListAndMemories& list);
  bool could_go_on(double step_of_scene) const;

  Topology topology_;
  Interaction interaction_;
  LoadsAndConstraints loads_;
  State state_;
  double time_step_ = 0;
  int divided_ = 1;
  Stepping stepping_;
  std::vector<double> thermostat_variables_;
  std::vector<int> loaded_;                  // elements
  std::vector<ConstraintImpulse> impulses_;  // impulses in the last kick
  Gauges gauges_;
  TubeParts parts_;
  bool tunes_skin_ = false;
  NeighbourList list_;
  std::int64_t list_age_ = 0;     // steps since the list was built
  std::vector<Change> changes_;   // since then, of cached_elements each
  std::vector<Fastest> fastest_;  // fastest element of each cached_elements in the last drift
  ForceEngine engine_;
  Forces forces_;                       // with the loads
  std::vector<PointLoad> point_loads_;  // loads in forces_, which may depend on the velocities in the middle of the step
  EnergySupply account_;
  Relaxation relaxation_;
  Rest rest_;
  double list_seconds_ = 0, integration_seconds_ = 0;

  // A copy of a simulation has no device. Copying is an error while the device has a newer state.
  struct OwnDevice {
    std::shared_ptr<DeviceStepper> stepper;  // its own
    bool device_is_current = false;          // the device goes on from its state, with the loads and gauges of now
    bool host_is_stale = false;              // its state is newer than the one here
    bool energies_missing = false;           // those of its state are asked for and not computed yet
    std::vector<Segment> hosted;             // what this processor moves

    OwnDevice() = default;
    OwnDevice(const OwnDevice& other) {
      if (other.host_is_stale || other.energies_missing)
        throw std::logic_error("a simulation is copied that is on a device");
    }
    OwnDevice(OwnDevice&&) = default;
    OwnDevice& operator=(OwnDevice&&) = default;
    OwnDevice& operator=(const OwnDevice& other) { return *this = OwnDevice(other); }
  };
  OwnDevice device_;
};

}  // namespace ropewalk
