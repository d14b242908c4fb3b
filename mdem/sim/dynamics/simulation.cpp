#include "sim/dynamics/simulation.hpp"

#include <omp.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "model/contract.hpp"
#include "model/error.hpp"
#include "sim/contact/shared/wrapped.hpp"
#include "sim/device/device_stepper.hpp"
#include "sim/dynamics/blow_up.hpp"
#include "sim/dynamics/spins.hpp"
#include "sim/dynamics/verlet.hpp"
#include "sim/forces/kick.hpp"
#include "sim/state/motion.hpp"
#include "sim/threads/for_each.hpp"

namespace ropewalk {
namespace {

bool finite(const Vector3& v) { return std::isfinite(v.squaredNorm()); }

// Before any force spreads it to the neighbours.
void refuse_places(const State& s) {
  for (std::size_t i = 0; i < s.size(); ++i)
    if (!finite(s.position[i]) || !finite(s.velocity[i]) || !finite(s.angular_velocity[i]) ||
        !std::isfinite(s.orientation[i].squaredNorm()))
      throw NumericalError(s.step, static_cast<int>(i), "its position, orientation or velocity is not finite",
                           "start from another state");
  for (std::size_t i = 0; i < s.size(); ++i)
    if (s.position[i].lpNorm<Eigen::Infinity>() > farthest_coordinate)
      throw NumericalError(s.step, static_cast<int>(i),
                           "it lies more than 3 cm from the origin, where coordinates end",
                           "move the rope to the origin");
}

bool relaxes_spins(const LoadsAndConstraints& loads) { return loads.spin_relaxation_interval() > 0; }

NumericalError blown_up(long step, int element) {
  return NumericalError(step, element,
                        "the motion blew up (an element moves a quarter of its radius or "
                        "turns half a radian in one step)",
                        "use a smaller time step or a gentler start and load");
}

// Calls work(block, begin, end) for all elements in blocks that stay in the first cache, by all threads.
template <class Work>
void for_blocks(std::size_t elements, const Work& work) {
  const auto n = static_cast<std::ptrdiff_t>(elements);
  for_each((n + cached_elements - 1) / cached_elements, elements > parallel_from, [&](std::ptrdiff_t block) {
    const std::ptrdiff_t begin = block * cached_elements;
    work(static_cast<std::size_t>(block), begin, std::min(begin + cached_elements, n));
  });
}
std::size_t blocks_of(std::size_t elements) { return (elements + cached_elements - 1) / cached_elements; }

}  // namespace

Simulation::Simulation(Topology topology, Interaction interaction, LoadsAndConstraints loads, State state,
                       double time_step, double skin, Stepping stepping)
    : topology_(std::move(topology)),
      interaction_(std::move(interaction)),
      loads_(std::move(loads)),
      state_(std::move(state)),
      time_step_(time_step),
      stepping_(std::move(stepping)),
      loaded_(loaded_elements(loads_)),
      gauges_(topology_, tube_ends(topology_), state_),
      parts_(topology_),
      tunes_skin_(!(skin > 0)),
      list_(interaction_, skin > 0 ? skin : default_skin(interaction_)),
      changes_(blocks_of(state_.size())),
      fastest_(blocks_of(state_.size())),
      forces_(state_.size()) {
  ROPEWALK_EXPECTS(static_cast<int>(state_.size()) == topology_.elements() && time_step_ > 0 && skin >= 0);
  refuse_places(state_);
  if (stepping_.thermostat) thermostat_variables_ = stepping_.thermostat->initial_variables();
  list_.build(topology_, state_);
  compute();
  constrain(topology_, loads_, state_.time, 0.0, state_);
}

// --- what a step is made of ---------------------------------------------------------------------------

struct Simulation::System {
  Simulation& s;
  bool energies;

  EnergySupply& account() { return s.account_; }
  void kick(double dt) { s.kick(dt); }
  void add_work_of_loads(double dt) {
    s.account_.work += dt * load_power(s.point_loads_, s.state_);
    s.gauges_.add_loads(s.state_, s.point_loads_, dt);
  }
  void drift(double dt) { s.drift(dt); }
  void bathe(double dt) { s.bathe(dt); }
  double kinetic_energy() const { return ropewalk::kinetic_energy(s.topology_, s.state_); }
  double damped(double dt) const { return s.forces_.lost - dt * s.forces_.damping_power; }
  void compute_forces() {
    if (s.device_.stepper) return s.compute_on_device();
    s.update_list();
    s.compute(energies, s.part_step());
    s.check_forces(energies);
  }
};

void Simulation::steps(long count, bool energies) {
  ROPEWALK_EXPECTS(count >= 0);
  end_relaxation();
  const bool always = relaxes_spins(loads_);
  for (long k = 0; k < count; ++k) {
    const double began = omp_get_wtime(), elsewhere = engine_seconds() + list_seconds_;
    if (device_.stepper) upload();
    step_once((energies && k + 1 == count) || always);
    integration_seconds_ += omp_get_wtime() - began - (engine_seconds() + list_seconds_ - elsewhere);
  }
  if (device_.stepper && count > 0) device_.energies_missing = energies;
}

void Simulation::step_once(bool energies) {
  ++state_.step;
  for (state_.part = 0; state_.part < divided_; ++state_.part) {
    const bool last = state_.part + 1 == divided_;
    System system{*this, energies && last};
    begin_step(system, part_step(), stepping_.thermostat != nullptr);
    system.compute_forces();
    end_step(system, part_step());
  }
  state_.part = 0;
  relax_spins_if_due();
}

// --- motion -------------------------------------------------------------------------------------------

void Simulation::kick(double dt) {
  if (device_.stepper) {
    device_.stepper->kick(dt);
    for (const Segment& part : device_.hosted)
      ropewalk::kick(topology_, nullptr, rows_of(forces_), dt, part, state_);
  } else {
    account_.dissipated += kick_all(topology_, engine_.terms(), rows_of(forces_), dt, parts_.count(),
                                    [this](int k) { return parts_[k]; }, state_);
  }
  if (loads_.empty()) return;
  constrain(topology_, loads_, loaded_, state_.time, 0.5 * part_step(), forces_, dt, state_, impulses_);
  for (const ConstraintImpulse& c : impulses_) account_.work += c.work;
  gauges_.add_constraints(state_, impulses_);
}

// Blocks with a velocity that is not finite stay where they are.
void Simulation::move(double dt) {
  const auto free_motion = stepping_.runge_kutta ? move_elements_runge_kutta : move_elements;
  for_blocks(state_.size(), [&](std::size_t block, std::ptrdiff_t begin, std::ptrdiff_t end) {
    fastest_[block] = fastest(state_, begin, end);
    if (std::isfinite(fastest_[block].sum)) free_motion(state_, dt, begin, end);
  });
}

void Simulation::drift(double dt) {
  if (device_.stepper) {
    for (const Segment& part : device_.hosted) move_elements(state_, dt, part.begin, part.end);
    device_.stepper->drift(dt, state_, list_);
    state_.time += dt;
    gauges_.follow(state_);
    return;
  }
  move(dt);
  state_.time += dt;
  gauges_.follow(state_);
  const MotionBound bound(topology_.largest_radius(), part_step());
  if (!std::all_of(fastest_.begin(), fastest_.end(), [&](const Fastest& f) { return bound.holds(f); }))
    refuse_blow_up(bound);
}

void Simulation::refuse_blow_up(const MotionBound& bound) const {
  int broken = 0;
  while (broken + 1 < topology_.elements() && bound.holds(fastest(state_, broken, broken + 1))) ++broken;
  throw blown_up(state_.step, broken);
}

// Constrained components take no part: they are as before afterwards.
void Simulation::bathe(double dt) {
  stepping_.thermostat->apply(topology_, dt, state_, thermostat_variables_);
  constrain(topology_, loads_, state_.time, 0.0, state_);
}

void Simulation::update_list() {
  if (!(list_.cutoff > 0)) return;
  const double began = omp_get_wtime();
  ++list_age_;
  for_blocks(state_.size(), [&](std::size_t block, std::ptrdiff_t begin, std::ptrdiff_t end) {
    changes_[block] = list_.change(state_, begin, end);
  });
  Change all;  // summed in the order of the blocks, whatever the threads
  for (const Change& c : changes_) all = both(all, c);
  if (list_.stale(all)) {
    if (tunes_skin_ && engine_.contact())
      list_.skin = engine_.contact()->best_skin(topology_, list_.skin, list_age_);
    list_.build(topology_, state_);
    list_age_ = 0;
  }
  list_seconds_ += omp_get_wtime() - began;
}

// --- forces -------------------------------------------------------------------------------------------

// Model forces at the present positions and velocities, plus loads: their sum in `forces_`.
void Simulation::compute(bool energies, std::optional<double> passed) {
  engine_.compute(topology_, interaction_, list_, state_, forces_, {Parts::all, energies, passed});
  if (!energies) forces_.energy.vdw = std::numeric_limits<double>::quiet_NaN();
  add_point_loads();
}

void Simulation::add_point_loads() {
  point_loads(loads_, state_, state_.time, point_loads_);
  for (const PointLoad& load : point_loads_) {
    forces_.force.add(static_cast<std::size_t>(load.element), load.force);
    forces_.torque.add(static_cast<std::size_t>(load.element), load.torque);
  }
}

void Simulation::check_forces(bool energies) const {
  const double energy = energies ? forces_.energy.potential() : forces_.energy.bonds();
  if (!std::isfinite(energy)) throw blown_up(state_.step, -1);
  check_slip();
}

void Simulation::check_slip() const {
  if (forces_.slipping_bond >= 0)
    throw NumericalError(state_.step, forces_.slipping_bond,
                         "the bond to the next element is twisted by 90 degrees and cannot carry more torque",
                         "use shorter elements or less twist, or let such bonds break by [failure]");
}

// For [twist] with geometric_only.
void Simulation::relax_spins_if_due() {
  if (!relaxes_spins_at(state_.time, time_step_, loads_.spin_relaxation_interval())) return;
  if (device_.stepper) device_.energies_missing = true;
  const double had = total_energy();
  sync_to_host();
  relax_spins(topology_, state_);
  compute();
  account_.dissipated += had - total_energy();
}

void Simulation::use_loads(LoadsAndConstraints loads) {
  end_relaxation();
  sync_to_host();
  const auto add = [this](double sign) {
    for (const PointLoad& load : point_loads_) {
      forces_.force.add(static_cast<std::size_t>(load.element), sign * load.force);
      forces_.torque.add(static_cast<std::size_t>(load.element), sign * load.torque);
    }
  };
  add(-1);
  loads_ = std::move(loads);
  loaded_ = loaded_elements(loads_);
  point_loads(loads_, state_, state_.time, point_loads_);
  add(1);
}

EndReadings Simulation::read_gauges() {
  if (state_.time > gauges_.sums.since) return gauges_.read(state_);
  return gauges_.read_still(state_, reactions_at_rest(topology_, loads_, loaded_, forces_, state_), point_loads_);
}

void Simulation::use_thermostat(std::shared_ptr<const Thermostat> thermostat) {
  if (device_.stepper && thermostat)
    throw std::invalid_argument("a device cannot run this scene: devices have no thermostat");
  stepping_.thermostat = std::move(thermostat);
  std::vector<double> variables;
  if (stepping_.thermostat) variables = stepping_.thermostat->initial_variables();
  if (variables.size() != thermostat_variables_.size()) thermostat_variables_ = std::move(variables);
}

void Simulation::set_memory(const std::vector<double>& memory) {
  sync_to_host();
  engine_.set_memory(interaction_, memory, topology_.elements());
  engine_.prepare_again(topology_, list_, state_);
  compute();
}

Forces Simulation::forces_at(const State& state, Interaction::Precision precision) const {
  ROPEWALK_EXPECTS(state.size() == state_.size());
  Interaction in = interaction_;
  in.precision = precision;
  ForceEngine engine;
  engine.take_terms_of(engine_);
  Forces forces(state.size());
  engine.compute(topology_, in, list_, state, forces);
  return forces;
}

double Simulation::engine_seconds() const {
  const ForceEngine::Times& t = engine_.times();
  return t.contact + t.bonds;
}

std::size_t Simulation::bytes() const {
  const std::size_t n = state_.size();
  const std::size_t state = (3 + 4 + 3 + 3) * n, forces = 6 * n;
  const std::size_t reference = 6 * n;  // numbers of the reference state of the list
  return (state + forces + reference) * sizeof(double) + engine_.bytes() + list_.bytes();
}

}  // namespace ropewalk
