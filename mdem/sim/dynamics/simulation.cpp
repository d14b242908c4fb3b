#include "sim/dynamics/simulation.hpp"

#include <omp.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <utility>

#include "model/error.hpp"
#include "sim/dynamics/fire.hpp"
#include "sim/state/motion.hpp"

namespace ropewalk {
namespace {

bool finite(const Vector3& v) { return std::isfinite(v.squaredNorm()); }

// The first element with a number that is not finite in these; -1: none.
int not_finite(const Vec3Array& a, const Vec3Array& b) {
  for (std::size_t i = 0; i < a.size(); ++i)
    if (!finite(a[i]) || !finite(b[i])) return static_cast<int>(i);
  return -1;
}

// Before any force spreads it to the neighbours.
void refuse_not_finite(const State& s) {
  int broken = std::max(not_finite(s.position, s.velocity), not_finite(s.angular_velocity, s.angular_velocity));
  for (std::size_t i = 0; i < s.size() && broken < 0; ++i)
    if (!std::isfinite(s.orientation[i].squaredNorm())) broken = static_cast<int>(i);
  if (broken >= 0)
    throw NumericalError(s.step, broken, "its place, turn or velocity is not finite", "start from another state");
}

// What an element may move and turn in a step; a velocity that is not finite is no little motion.
struct LittleMotion {
  double speed2, spin2;
  LittleMotion(double radius, double step) : speed2(square(0.25 * radius / step)), spin2(square(0.5 / step)) {}
  static double square(double x) { return x * x; }
  bool holds(const Fastest& f) const { return f.speed2 < speed2 && f.spin2 < spin2 && std::isfinite(f.sum); }
};

bool relaxes_spins(const LoadsAndConstraints& loads) { return loads.spin_relaxation_interval() > 0; }

NumericalError blown_up(long step, int element) {
  return NumericalError(step, element,
                        "the motion blew up (an element moves a quarter of its radius or "
                        "turns half a radian in one step)",
                        "use a smaller time step or a gentler start and load");
}

}  // namespace

Simulation::Simulation(Topology topology, Interaction interaction, LoadsAndConstraints loads, State state,
                       double time_step, double skin, Stepping stepping)
    : topology_(std::move(topology)),
      interaction_(std::move(interaction)),
      loads_(std::move(loads)),
      state_(std::move(state)),
      time_step_(time_step),
      stepping_(stepping),
      elements_(topology_, loaded_elements(loads_)),
      tunes_skin_(!(skin > 0) && !interaction_.line.empty()),
      list_(interaction_, skin > 0 ? skin : default_skin(interaction_)),
      moved_(static_cast<std::size_t>(elements_.blocks()) + 1),
      forces_(state_.size()),
      inner_(two_levels() ? state_.size() : 0),
      contact_(two_levels() ? state_.size() : 0) {
  refuse_not_finite(state_);
  list_.build(topology_, state_);
  compute();
  constrain(topology_, loads_, state_.time, forces_, 0.0, state_);
}

// Model forces at the present positions and velocities, plus loads; `forces_` holds the sum.
void Simulation::compute(bool energies, bool axes_made, const Drift* then) {
  if (two_levels()) {
    compute_bonds();
    compute_contact(energies);
    add_levels();
    return;
  }
  ForceOptions options{Parts::all, energies, axes_made};
  if (then)
    options.then = [&](int block, const ForcesOn& forces) {
      keep_on_driven(block, forces);
      drift_block(block, forces, *then);
    };
  engine_.compute(topology_, interaction_, list_, state_, forces_, options);
  if (!energies) forces_.energy.vdw = std::numeric_limits<double>::quiet_NaN();
  add_loads(forces_);
}

// They are moved after the loads and constraints on them are known: until then their forces are kept.
void Simulation::keep_on_driven(int block, const ForcesOn& forces) {
  for (const ElementRange& of : elements_.driven(block))
    for (std::ptrdiff_t i = of.begin; i < of.end; ++i) {
      const auto from = static_cast<std::size_t>(i - forces.origin), to = static_cast<std::size_t>(i);
      forces_.force.set(to, forces.force[from]);
      forces_.torque.set(to, forces.torque[from]);
    }
}

void Simulation::compute_bonds() {
  engine_.compute(topology_, interaction_, list_, state_, inner_, {Parts::bonds});
  add_loads(inner_);
}

void Simulation::compute_contact(bool energies) {
  engine_.compute(topology_, interaction_, list_, state_, contact_, {Parts::contact, energies});
  if (!energies) contact_.energy.vdw = std::numeric_limits<double>::quiet_NaN();
}

void Simulation::add_loads(Forces& forces) {
  point_loads(loads_, state_, state_.time, point_loads_);
  for (const PointLoad& load : point_loads_) {
    forces.force.add(static_cast<std::size_t>(load.element), load.force);
    forces.torque.add(static_cast<std::size_t>(load.element), load.torque);
  }
}

void Simulation::add_levels() {
  const auto n = static_cast<std::ptrdiff_t>(state_.size());
  const auto add = [&](const Vec3Array& a, const Vec3Array& b, Vec3Array& sum) {
#pragma omp parallel for schedule(static) if (state_.size() > parallel_from)
    for (std::ptrdiff_t i = 0; i < n; ++i) {
      sum.x[i] = a.x[i] + b.x[i];
      sum.y[i] = a.y[i] + b.y[i];
      sum.z[i] = a.z[i] + b.z[i];
    }
  };
  add(inner_.force, contact_.force, forces_.force);
  add(inner_.torque, contact_.torque, forces_.torque);
  forces_.energy = inner_.energy;
  forces_.energy.vdw = contact_.energy.vdw;
  forces_.damping_power = inner_.damping_power + contact_.damping_power;
  forces_.slipping_bond = inner_.slipping_bond;
}

// The elements of one tube; returns what the local damping takes out.
double Simulation::kick_tube(const Forces& forces, int tube, double dt) {
  const double alpha = interaction_.damping.local;
  const std::ptrdiff_t from = topology_.tube_begin[tube], to = topology_.tube_begin[tube + 1];
  if (alpha <= 0) {
    kick_range(rows_of(forces), {from, to, topology_.tube_type[static_cast<std::size_t>(tube)]}, dt);
    return 0;
  }
  const double per_mass = dt / topology_.type_of(tube).mass, per_inertia = dt / topology_.type_of(tube).inertia;
  double removed = 0;
  const auto push = [&](const std::vector<double>& force, double inverse, std::vector<double>& velocity) {
    for (std::ptrdiff_t i = from; i < to; ++i) {
      const double brake = pfc_local(alpha, force[i], velocity[i]);
      const double next = velocity[i] + inverse * (force[i] + brake);
      removed -= 0.5 * dt * brake * (velocity[i] + next);
      velocity[i] = next;
    }
  };
  push(forces.force.x, per_mass, state_.velocity.x);
  push(forces.force.y, per_mass, state_.velocity.y);
  push(forces.force.z, per_mass, state_.velocity.z);
  push(forces.torque.x, per_inertia, state_.angular_velocity.x);
  push(forces.torque.y, per_inertia, state_.angular_velocity.y);
  push(forces.torque.z, per_inertia, state_.angular_velocity.z);
  return removed;
}

void Simulation::kick(const Forces& forces, double dt) {
  // Added up in the order of the tubes, whatever the threads.
  removed_.resize(static_cast<std::size_t>(topology_.tubes()));
#pragma omp parallel for schedule(static) if (state_.size() > parallel_from)
  for (int t = 0; t < topology_.tubes(); ++t) removed_[static_cast<std::size_t>(t)] = kick_tube(forces, t, dt);
  for (double removed : removed_) dissipated_ += removed;
  work_ += constrain(topology_, loads_, state_.time, forces, dt, state_);
}

// `forces` holds the loads as well.
void Simulation::kick_with_loads(const Forces& forces, double dt) {
  work_ += 0.5 * dt * load_power(point_loads_, state_);
  kick(forces, dt);
  work_ += 0.5 * dt * load_power(point_loads_, state_);
}

// Without local damping.
void Simulation::kick_range(const ForcesOn& forces, const ElementRange& of, double dt) {
  const TubeType& type = topology_.types[static_cast<std::size_t>(of.type)];
  kick_elements(forces.force, forces.origin, dt / type.mass, state_.velocity, of.begin, of.end);
  kick_elements(forces.torque, forces.origin, dt / type.inertia, state_.angular_velocity, of.begin, of.end);
}

// As kick_with_loads does so many times, but only the elements that loads and constraints act on.
void Simulation::kick_driven(int kicks, double dt) {
  for (int k = 0; k < kicks; ++k) {
    work_ += 0.5 * dt * load_power(point_loads_, state_);
    for (const ElementRange& of : elements_.driven()) kick_range(rows_of(forces_), of, dt);
    work_ += constrain(topology_, loads_, state_.time, forces_, dt, state_);
    work_ += 0.5 * dt * load_power(point_loads_, state_);
  }
}

void Simulation::drift_range(const ElementRange& of, const ForcesOn& forces, const Drift& by, Moved& moved) {
  const auto move = stepping_.runge_kutta ? move_elements_runge_kutta : move_elements;
  const LittleMotion little(topology_.largest_radius(), time_step_);
  for (std::ptrdiff_t begin = of.begin, end; begin < of.end; begin = end) {
    end = std::min(begin + cached_elements, of.end);
    for (int k = 0; k < by.kicks; ++k) kick_range(forces, {begin, end, of.type}, 0.5 * by.dt);
    const Fastest speeds = fastest(state_, begin, end);
    moved.little = moved.little && little.holds(speeds);
    moved.speed2 = std::max(moved.speed2, speeds.speed2);
    moved.spin2 = std::max(moved.spin2, speeds.spin2);
    if (std::isfinite(speeds.sum)) move(state_, by.dt, begin, end);
    if (by.axes) engine_.make_axes(state_, begin, end);
    if (by.looks) moved.change = both(moved.change, list_.change(state_, begin, end));
  }
  moved.looked = by.looks;
}

// All that is free in it.
void Simulation::drift_block(int block, const ForcesOn& forces, const Drift& by) {
  Moved moved;
  for (const ElementRange& of : elements_.free(block)) drift_range(of, forces, by, moved);
  moved_[static_cast<std::size_t>(block)] = moved;
}

void Simulation::drift_driven(const Drift& by) {
  kick_driven(by.kicks, 0.5 * by.dt);
  Moved moved;
  for (const ElementRange& of : elements_.driven())
    drift_range(of, rows_of(forces_), {by.dt, 0, by.axes, by.looks}, moved);
  moved_.back() = moved;
}

void Simulation::drift_free(const Drift& by) {
#pragma omp parallel for schedule(static) if (state_.size() > parallel_from)
  for (int block = 0; block < elements_.blocks(); ++block) drift_block(block, rows_of(forces_), by);
}

void Simulation::drift(const Drift& by) {
  drift_free(by);
  drift_driven(by);
}

// In the order of the blocks, whatever the threads.
Simulation::Moved Simulation::all_moved() const {
  Moved all;
  for (const Moved& of : moved_) {
    all.change = both(all.change, of.change);
    all.speed2 = std::max(all.speed2, of.speed2);
    all.spin2 = std::max(all.spin2, of.spin2);
    all.little = all.little && of.little;
    all.looked = all.looked && of.looked;
  }
  return all;
}

void Simulation::look() {
  const auto change = [&](const Span<ElementRange>& ranges, Moved& moved) {
    moved.change = {};
    moved.looked = true;
    for (const ElementRange& of : ranges) moved.change = both(moved.change, list_.change(state_, of.begin, of.end));
  };
#pragma omp parallel for schedule(static) if (state_.size() > parallel_from)
  for (int block = 0; block < elements_.blocks(); ++block)
    change(elements_.free(block), moved_[static_cast<std::size_t>(block)]);
  change(elements_.driven(), moved_.back());
}

// After a drift. Where all are slow nobody looks how far each has come until, together, they may have come far
// enough to matter: what is out of reach by less is met in vain, and a plan of the line law holds for five times
// the angle.
void Simulation::update_list(Moved all) {
  constexpr double far = 0.002, much = 0.0003, more = 1.001;  // nm; rad; for rounding
  ++list_age_;
  const double turned = more * time_step_ * std::sqrt(all.spin2),
               moved = more * time_step_ * std::sqrt(all.speed2) + list_.lever * turned;
  if (!all.looked) {
    unseen_ = {unseen_.moved + moved, unseen_.turned + turned};
    if (!list_.holds_after(moved, turned)) {
      look();
      all = all_moved();
    }
  }
  if (all.looked) unseen_ = {};
  looks_ = !(unseen_.moved + moved <= far && unseen_.turned + turned <= much);
  if (!all.looked || !list_.worn(all.change)) return;
  if (tunes_skin_) list_.skin = engine_.line().list().best_skin(topology_, list_.skin, list_age_);
  list_.build(topology_, state_);
  list_age_ = 0;
}

// The velocities of the last drift.
void Simulation::check_motion(const Moved& all) const {
  if (all.little) return;
  const LittleMotion little(topology_.largest_radius(), time_step_);
  int broken = 0;
  while (broken + 1 < topology_.elements() && little.holds(fastest(state_, broken, broken + 1))) ++broken;
  throw blown_up(state_.step, broken);
}

// The local damping brakes by the velocities before each kick, and spins are relaxed between two steps.
bool Simulation::kicks_while_moving() const { return interaction_.damping.local <= 0 && !relaxes_spins(loads_); }

void Simulation::steps(long count, bool energies) {
  const bool always = relaxes_spins(loads_);
  for (long k = 0; k < count; ++k) {
    const bool wanted = (energies && k + 1 == count) || always;
    if (two_levels()) {
      two_level(wanted);
    } else {
      one_level(k, count, wanted);
    }
  }
}

// In the middle of several steps all that is free is kicked and goes on as soon as its forces are there, the rest
// after it: the next step finds everything in its place, with the velocities of half a step later.
void Simulation::one_level(long step, long count, bool energies) {
  const double dt = time_step_;
  const bool at_once = kicks_while_moving(), goes_on = at_once && step + 1 < count,
             axes = interaction_.has_contact();
  const double t0 = omp_get_wtime(), then_before = engine_.times().then;
  if (!at_once) kick_with_loads(forces_, 0.5 * dt);
  if (!at_once || step == 0) drift({dt, at_once ? 1 : 0, axes, looks_});
  ++state_.step;
  state_.time += dt;
  const Moved moved = all_moved();
  check_motion(moved);
  const double t1 = omp_get_wtime();
  update_list(moved);
  const double t2 = omp_get_wtime();
  const Drift onward{dt, 2, axes, looks_};
  compute(energies, axes, goes_on ? &onward : nullptr);
  const double t3 = omp_get_wtime();
  // A bond that slips is shown where it did.
  if (goes_on && forces_.slipping_bond >= 0) drift_free({-dt, 0, false, false});
  check_forces(energies);
  if (goes_on) drift_driven(onward);
  dissipated_ -= dt * forces_.damping_power;
  if (!goes_on) kick_with_loads(forces_, 0.5 * dt);
  relax_angles_if_due();
  integration_seconds_ += (t1 - t0) + (omp_get_wtime() - t3) + (engine_.times().then - then_before);
  list_seconds_ += t2 - t1;
}

// With the velocities in the middle of the contact's impulse, as the last one lets expect them: before it, those of
// a loaded rope are off by what the bonds alone have done, and the viscosity would take out what is no sliding.
void Simulation::compute_contact_in_impulse(bool energies) {
  const Vec3Array velocity = state_.velocity, angular_velocity = state_.angular_velocity;
  const double work = work_;
  kick(contact_, 0.5 * time_step_);
  compute_contact(energies);
  state_.velocity = velocity;
  state_.angular_velocity = angular_velocity;
  work_ = work;
}

void Simulation::two_level(bool energies) {
  const double dt = time_step_, inner = inner_step();
  const auto in_engine = [&] {
    const auto& t = engine_.times();
    return t.axes + t.contact + t.bonds;
  };
  const double t0 = omp_get_wtime(), before = in_engine();
  kick(contact_, 0.5 * dt);
  kick_with_loads(inner_, 0.5 * inner);
  for (int k = 1; k <= stepping_.contact_every; ++k) {
    drift({inner, 0, false, k == stepping_.contact_every});
    state_.time += inner;
    compute_bonds();
    dissipated_ -= inner * inner_.damping_power;
    // The second half of one step and the first one of the next have the same forces.
    kick_with_loads(inner_, k < stepping_.contact_every ? inner : 0.5 * inner);
  }
  ++state_.step;
  const Moved moved = all_moved();
  check_motion(moved);
  const double t1 = omp_get_wtime();
  update_list(moved);
  const double listed = omp_get_wtime() - t1;
  compute_contact_in_impulse(energies);
  add_levels();
  check_forces(energies);
  dissipated_ -= dt * contact_.damping_power;
  kick(contact_, 0.5 * dt);
  relax_angles_if_due();
  integration_seconds_ += omp_get_wtime() - t0 - listed - (in_engine() - before);
  list_seconds_ += listed;
}

void Simulation::check_forces(bool energies) const {
  const double energy = energies ? forces_.energy.potential() : forces_.energy.bonds();
  if (!std::isfinite(energy)) throw blown_up(state_.step, -1);
  if (forces_.slipping_bond >= 0)
    throw NumericalError(state_.step, forces_.slipping_bond,
                         "the bond to the next element is twisted by 90 degrees, where its torque is largest: it "
                         "is about to slip and forget a turn",
                         "lower the twisting moment");
}

void Simulation::relax_angles_if_due() {
  const double interval = loads_.spin_relaxation_interval();
  if (interval <= 0) return;
  const auto increments = [&](double time) { return std::floor(time / interval + 1e-9); };
  if (increments(state_.time) == increments(state_.time - time_step_)) return;
  const double had = total_energy();
  relax_spins(topology_, state_);
  compute();
  dissipated_ += had - total_energy();
}

double Simulation::largest_force() const {
  // What the constraints let through of velocities is what they let through of forces.
  State free = state_;
  free.velocity = forces_.force;
  free.angular_velocity = forces_.torque;
  constrain(topology_, loads_, state_.time, forces_, 0.0, free);
  double largest = 0;
  const double radius = topology_.largest_radius();
  for (std::size_t i = 0; i < free.size(); ++i) {
    const double force = free.velocity[i].norm(), torque = free.angular_velocity[i].norm() / radius;
    if (!std::isfinite(force + torque)) return std::numeric_limits<double>::quiet_NaN();
    largest = std::max({largest, force, torque});
  }
  return largest;
}

// FIRE. Rotations take part with their angular velocities scaled by sqrt(I/m), so that both kinds of motion mix in
// one power.
bool Simulation::relax(double tolerance, long max_steps, const std::function<bool(long)>& progress) {
  // One ratio for all tube types: it only weighs turning against moving.
  const TubeType& lightest = *std::min_element(topology_.types.begin(), topology_.types.end(),
                                               [](const auto& a, const auto& b) { return a.mass < b.mass; });
  const double scale2 = lightest.inertia / lightest.mass;
  Fire fire(inner_step());
  const std::size_t n = state_.size();
  const auto stop = [&] {
    state_.velocity = Vec3Array(n);
    state_.angular_velocity = Vec3Array(n);
  };
  stop();
  const double most_move = Fire::farthest(lightest.radius);
  for (long k = 0; k < max_steps; ++k) {
    if (k % Fire::check_every == 0 && largest_force() < tolerance) return true;
    if (!progress(k)) return false;
    double power = 0, v2 = 0, f2 = 0, fastest2 = 0;
    for (std::size_t i = 0; i < n; ++i)
      power += forces_.force[i].dot(state_.velocity[i]) + forces_.torque[i].dot(state_.angular_velocity[i]);
    if (power > 0) {
      fire.went_down();
    } else {
      if (k > 0) drift({-0.5 * fire.dt, 0, false, false});
      stop();
      fire.went_up();
    }
    const double dt = fire.dt, mix = fire.mix;
    for (int t = 0; t < topology_.tubes(); ++t) {
      const TubeType& type = topology_.type_of(t);
      for (int e = topology_.tube_begin[t]; e < topology_.tube_begin[t + 1]; ++e) {
        const auto i = static_cast<std::size_t>(e);
        state_.velocity.add(i, dt / type.mass * forces_.force[i]);
        state_.angular_velocity.add(i, dt / type.inertia * forces_.torque[i]);
      }
    }
    constrain(topology_, loads_, state_.time, forces_, 0.0, state_);
    for (std::size_t i = 0; i < n; ++i) {
      v2 += state_.velocity[i].squaredNorm() + scale2 * state_.angular_velocity[i].squaredNorm();
      f2 += forces_.force[i].squaredNorm() + forces_.torque[i].squaredNorm() / scale2;
    }
    if (!std::isfinite(v2 + f2))
      throw NumericalError(state_.step, not_finite(forces_.force, forces_.torque),
                           "relaxation met a force that is not finite", "start from a state without overlaps");
    const double turn = f2 > 0 ? mix * std::sqrt(v2 / f2) : 0.0;
    for (std::size_t i = 0; i < n; ++i) {
      state_.velocity.set(i, (1 - mix) * state_.velocity[i] + turn * forces_.force[i]);
      state_.angular_velocity.set(i, (1 - mix) * state_.angular_velocity[i] + turn / scale2 * forces_.torque[i]);
    }
    constrain(topology_, loads_, state_.time, forces_, 0.0, state_);
    for (std::size_t i = 0; i < n; ++i)
      fastest2 =
          std::max(fastest2, state_.velocity[i].squaredNorm() + scale2 * state_.angular_velocity[i].squaredNorm());
    const double step = std::min(dt, fastest2 > 0 ? most_move / std::sqrt(fastest2) : dt);
    drift({step, 0, false, true});
    ++state_.step;
    update_list(all_moved());
    compute();
    if (forces_.slipping_bond >= 0) check_forces(true);
  }
  return largest_force() < tolerance;
}

std::size_t Simulation::bytes() const {
  const std::size_t n = state_.size();
  const std::size_t state = (3 + 4 + 3 + 3) * n, forces = (two_levels() ? 18 : 6) * n;
  const std::size_t reference = 6 * n;  // of the list
  return (state + forces + reference) * sizeof(double) + engine_.bytes() + list_.bytes();
}

namespace {

constexpr char magic[] = "MDEM8";

struct Writer {
  std::string bytes;
  template <class T>
  void put(const T& value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  void put(const std::vector<double>& v) {
    bytes.append(reinterpret_cast<const char*>(v.data()), v.size() * sizeof(double));
  }
};

struct Reader {
  const std::string& bytes;
  std::size_t at = 0;
  void need(std::size_t count) const {
    if (bytes.size() - at < count) throw std::runtime_error("the checkpoint ends too early");
  }
  template <class T>
  void get(T& value) {
    need(sizeof value);
    std::memcpy(&value, bytes.data() + at, sizeof value);
    at += sizeof value;
  }
  void get(std::vector<double>& v) {
    need(v.size() * sizeof(double));
    std::memcpy(v.data(), bytes.data() + at, v.size() * sizeof(double));
    at += v.size() * sizeof(double);
  }
};

// The arrays of a checkpoint in their order; const or not, as the arguments are.
template <class S, class F, class R>
auto checkpoint_arrays(S& s, F& f, R& ref, R& ref_axis) {
  return std::array{&s.position.x,
                    &s.position.y,
                    &s.position.z,
                    &s.orientation.w,
                    &s.orientation.x,
                    &s.orientation.y,
                    &s.orientation.z,
                    &s.velocity.x,
                    &s.velocity.y,
                    &s.velocity.z,
                    &s.angular_velocity.x,
                    &s.angular_velocity.y,
                    &s.angular_velocity.z,
                    &f.force.x,
                    &f.force.y,
                    &f.force.z,
                    &f.torque.x,
                    &f.torque.y,
                    &f.torque.z,
                    &ref.x,
                    &ref.y,
                    &ref.z,
                    &ref_axis.x,
                    &ref_axis.y,
                    &ref_axis.z};
}

template <class F>
auto force_arrays(F& f) {
  return std::array{&f.force.x, &f.force.y, &f.force.z, &f.torque.x, &f.torque.y, &f.torque.z};
}

}  // namespace

std::string Simulation::serialise() const {
  Writer w;
  w.bytes.append(magic, sizeof magic);
  w.put(static_cast<std::int64_t>(topology_.elements()));
  w.put(static_cast<std::int64_t>(topology_.tubes()));
  w.put(time_step_);
  w.put(state_.time);
  w.put(state_.step);
  w.put(work_);
  w.put(dissipated_);
  w.put(list_.skin);
  w.put(list_age_);
  w.put(list_.twist());
  for (const double x : {list_.displacement(), list_.turn(), unseen_.moved, unseen_.turned}) w.put(x);
  w.put(looks_);
  w.put(static_cast<std::int64_t>(stepping_.contact_every));
  for (const auto* v : checkpoint_arrays(state_, forces_, list_.reference(), list_.reference_axis())) w.put(*v);
  if (two_levels())
    for (const Forces* f : {&inner_, &contact_})
      for (const auto* v : force_arrays(*f)) w.put(*v);
  w.put(forces_.energy);
  w.put(forces_.damping_power);
  return std::move(w.bytes);
}

void Simulation::restore(const std::string& bytes) {
  Reader r{bytes};
  char found[sizeof magic];
  r.get(found);
  std::int64_t elements = 0, tubes = 0;
  r.get(elements);
  r.get(tubes);
  if (std::memcmp(found, magic, sizeof magic) != 0) throw std::runtime_error("not a checkpoint of this version");
  if (elements != topology_.elements() || tubes != topology_.tubes())
    throw std::runtime_error("the checkpoint holds " + std::to_string(tubes) + " tubes of " +
                             std::to_string(elements) + " elements, the scene " +
                             std::to_string(topology_.tubes()) + " of " + std::to_string(topology_.elements()));
  r.get(time_step_);
  r.get(state_.time);
  r.get(state_.step);
  r.get(work_);
  r.get(dissipated_);
  r.get(list_.skin);
  r.get(list_age_);
  std::array<double, 2> twist{};
  r.get(twist);
  std::array<double, 2> bounds{};
  r.get(bounds);
  r.get(unseen_.moved);
  r.get(unseen_.turned);
  r.get(looks_);
  std::int64_t contact_every = 0;
  r.get(contact_every);
  if (contact_every != stepping_.contact_every)
    throw std::runtime_error("the checkpoint is of contact_every = " + std::to_string(contact_every) +
                             ", the scene of " + std::to_string(stepping_.contact_every));
  Vec3Array ref(state_.size()), ref_axis(state_.size());
  for (auto* v : checkpoint_arrays(state_, forces_, ref, ref_axis)) r.get(*v);
  if (two_levels())
    for (Forces* f : {&inner_, &contact_})
      for (auto* v : force_arrays(*f)) r.get(*v);
  r.get(forces_.energy);
  r.get(forces_.damping_power);
  list_.build(topology_, std::move(ref), std::move(ref_axis));
  list_.set_twist(twist);
  list_.set_bounds(bounds[0], bounds[1]);
  // The spans of this list, which the skin of the next one follows from.
  Forces made(state_.size());
  if (tunes_skin_) engine_.compute(topology_, interaction_, list_, state_, made, {Parts::contact, false});
  point_loads(loads_, state_, state_.time, point_loads_);
}

}  // namespace ropewalk
