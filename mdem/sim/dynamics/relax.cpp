// Relaxation to a nearby minimum of the energy by FIRE (sim/dynamics/fire.hpp). Rotations take part with their
// angular velocities scaled by sqrt(I/m), so that both kinds of motion mix in one power.
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "model/contract.hpp"
#include "model/counter_random.hpp"
#include "model/error.hpp"
#include "sim/dynamics/fire.hpp"
#include "sim/dynamics/simulation.hpp"
#include "sim/state/motion.hpp"

namespace ropewalk {
namespace {

// The first element with a force or torque that is not finite; -1: none.
int not_finite(const Forces& f) {
  for (std::size_t i = 0; i < f.force.size(); ++i)
    if (!std::isfinite(f.force[i].squaredNorm() + f.torque[i].squaredNorm())) return static_cast<int>(i);
  return -1;
}

// The bond that is longest against its element; its first element.
struct LongestBond {
  double length = 0;  // relative to that of the element
  int element = -1;
};
LongestBond longest_bond(const Topology& topology, const Vec3Array& position) {
  LongestBond longest;
  for (int t = 0; t < topology.tubes(); ++t)
    for (int e = topology.tube_begin[t]; e + 1 < topology.tube_begin[t + 1]; ++e) {
      const auto i = static_cast<std::size_t>(e);
      const double length = (position[i + 1] - position[i]).norm() / topology.type_of(t).element_length;
      if (length > longest.length) longest = {length, e};
    }
  return longest;
}

// Adds the work of the loads over `dt`. No time passes: the impulses that the gauges have summed stay as they are.
void add_work(const std::vector<PointLoad>& loads, const State& state, double dt, EnergySupply& account,
              Gauges& gauges) {
  account.work += dt * load_power(loads, state);
  Gauges::Sums sums = gauges.sums;
  gauges.add_loads(state, loads, dt);
  for (const End end : {lower_end, upper_end}) sums.of[end].work = gauges.sums.of[end].work;
  gauges.sums = sums;
}

// The same of constraints: their forces are in the place of impulses.
void add_work(const std::vector<ConstraintImpulse>& reactions, const State& state, double dt, EnergySupply& account,
              Gauges& gauges) {
  std::vector<PointLoad> loads;
  for (const ConstraintImpulse& r : reactions) loads.push_back({r.element, r.linear, r.angular});
  add_work(loads, state, dt, account, gauges);
}

// Calls work(type, i) for every element.
template <class Work>
void for_elements(const Topology& topology, const Work& work) {
  for (int t = 0; t < topology.tubes(); ++t)
    for (int e = topology.tube_begin[t]; e < topology.tube_begin[t + 1]; ++e)
      work(topology.type_of(t), static_cast<std::size_t>(e));
}

}  // namespace

// Vectors of all elements: displacements and turns, velocities and spins, or forces and torques.
struct Simulation::Motion {
  Vec3Array linear, angular;

  double dot(const Motion& other) const {
    double sum = 0;
    for (std::size_t i = 0; i < linear.size(); ++i)
      sum += linear[i].dot(other.linear[i]) + angular[i].dot(other.angular[i]);
    return sum;
  }
  void add(double by, const Motion& other) {
    for (std::size_t i = 0; i < linear.size(); ++i) {
      linear.add(i, by * other.linear[i]);
      angular.add(i, by * other.angular[i]);
    }
  }
  void scale(double by) { add(by - 1, *this); }
};

// The accelerations that the constraints let through.
Simulation::Motion Simulation::free_accelerations(const Motion& forces) const {
  State free = state_;
  for_elements(topology_, [&](const TubeType& type, std::size_t i) {
    free.velocity.set(i, forces.linear[i] / type.mass);
    free.angular_velocity.set(i, forces.angular[i] / type.inertia);
  });
  constrain(topology_, loads_, before_all_motion, 0.0, free);
  return {free.velocity, free.angular_velocity};
}

double Simulation::largest_force() const {
  download();
  const Motion free = free_accelerations({forces_.force, forces_.torque});
  double largest = 0;
  for_elements(topology_, [&](const TubeType& type, std::size_t i) {
    const double force = type.mass * free.linear[i].norm(),
                 torque = type.inertia * free.angular[i].norm() / type.radius;
    largest = std::isfinite(force + torque) ? std::max({largest, force, torque})
                                            : std::numeric_limits<double>::quiet_NaN();
  });
  return largest;
}

// K times a motion, from the difference of two forces, in double.
class Simulation::Stiffness {
 public:
  explicit Stiffness(const Simulation& s)
      : s_(s), in_(s.interaction_), at_rest_{s.state_.velocity, s.state_.velocity} {
    in_.precision = Interaction::Precision::full;
    engine_.take_terms_of(s.engine_);
    at_rest_ = forces_after(at_rest_, 0);
  }
  const Motion& forces() const { return at_rest_; }
  Motion times(const Motion& motion) {
    constexpr double step = 1e-4;  // nm: less, and rounding hides the soft motions
    const double time = step / s_.farthest(motion);
    Motion fallen = forces_after(motion, time), out{Vec3Array(s_.state_.size()), Vec3Array(s_.state_.size())};
    fallen.add(-1, at_rest_);
    out.add(-1 / time, fallen);
    return out;
  }
  Motion softest_mode(Motion x, long most);
  // The most that the energy falls while the elements go along a motion, eV: the forces' work, by the trapezoidal
  // rule.
  double fall_along(const Motion& motion) {
    constexpr double step = 0.01, farthest = 0.2;  // displacement of the element that goes farthest, nm
    const double time = step / s_.farthest(motion);
    double most = 0, work = 0, power = at_rest_.dot(motion);
    for (int k = 1; k * step < 1.001 * farthest; ++k) {
      const double next = forces_after(motion, k * time).dot(motion);
      work += 0.5 * time * (power + next);
      power = next;
      most = std::max(most, work);
    }
    return most;
  }

 private:
  Motion forces_after(const Motion& motion, double time) {
    State s = s_.state_;
    s.velocity = motion.linear;
    s.angular_velocity = motion.angular;
    move_elements(s, time, 0, static_cast<std::ptrdiff_t>(s.size()));
    s.velocity.set_to_zero();
    s.angular_velocity.set_to_zero();
    Forces f(s.size());
    engine_.compute(s_.topology_, in_, s_.list_, s, f, {Parts::all, false});
    point_loads(s_.loads_, s, s.time, loads_);
    Motion forces{f.force, f.torque};
    for (const PointLoad& load : loads_) {
      forces.linear.add(static_cast<std::size_t>(load.element), load.force);
      forces.angular.add(static_cast<std::size_t>(load.element), load.torque);
    }
    return forces;
  }

  const Simulation& s_;
  Interaction in_;
  ForceEngine engine_;
  std::vector<PointLoad> loads_;
  Motion at_rest_;
};

double Simulation::farthest(const Motion& motion) const {
  double most = 0;
  for (std::size_t i = 0; i < state_.size(); ++i)
    most = std::max({most, motion.linear[i].norm(), topology_.largest_radius() * motion.angular[i].norm()});
  return most;
}

// F.K^-1.F/2 by conjugate gradients, with masses as the preconditioner. It grows with the iterations: one that is
// more than `enough` (eV) is returned as it is. M. R. Hestenes, E. Stiefel, J. Res. Natl. Bur. Stand. 49, 409
// (1952), DOI 10.6028/jres.049.044: what the last iterations have added is what is still missing. Infinite where K
// is not positive or `most` iterations are too few.
double Simulation::above_minimum(double enough, long most) const {
  constexpr double unknown = std::numeric_limits<double>::infinity();
  Stiffness stiffness(*this);
  Motion left = stiffness.forces(), free = free_accelerations(left), along = free;
  double power = left.dot(free), above = 0;
  const double first = power;
  std::vector<double> sums{0};
  long fewest = 30;  // each iteration carries forces one element farther along a tube
  for (int t = 0; t < topology_.tubes(); ++t) fewest = std::max(fewest, 3L * topology_.length_of(t));
  for (long k = 1; k <= most + fewest && power > 0; ++k) {
    const Motion resistance = stiffness.times(along);
    const double curvature = along.dot(resistance);
    if (!(curvature > 0)) return unknown;
    const double by = power / curvature;
    above += 0.5 * by * power;
    sums.push_back(above);
    const auto before = static_cast<std::size_t>(std::min(k, std::max(15L, k / 2)));
    const double lately = above - sums[sums.size() - 1 - before];
    if (above > enough) return above;
    if (k >= fewest && lately < 0.05 * above) return above + lately;
    left.add(-by, resistance);
    free = free_accelerations(left);
    const double next = left.dot(free);
    Motion turned = free;
    turned.add(next / power, along);
    along = turned;
    if (next < 1e-20 * first) return above;
    power = next;
  }
  return power > 0 ? unknown : above;
}

// The mode of K x = lambda M x with the lowest lambda: the steepest way down from a saddle. The search begins at
// the motion x, which must have a part of the mode. The energy falls much farther along the mode than along x,
// whose stiff parts cost energy. The method is LOBPCG with one vector: A. V. Knyazev, SIAM J. Sci. Comput. 23, 517
// (2001), DOI 10.1137/S1064827500366124.
Simulation::Motion Simulation::Stiffness::softest_mode(Motion x, long most) {
  constexpr long at_once = 25;     // iterations between two looks at lambda
  constexpr double change = 0.01;  // part of lambda: a smaller fall from look to look ends the search
  const auto mass_product = [&](const Motion& a, const Motion& b) {
    double sum = 0;
    for_elements(s_.topology_, [&](const TubeType& type, std::size_t i) {
      sum += type.mass * a.linear[i].dot(b.linear[i]) + type.inertia * a.angular[i].dot(b.angular[i]);
    });
    return sum;
  };
  struct Direction {
    Motion motion, force;  // K times it
    void add(double by, const Direction& other) {
      motion.add(by, other.motion);
      force.add(by, other.force);
    }
    void scale(double by) {
      motion.scale(by);
      force.scale(by);
    }
  };
  // Makes a direction orthogonal to others and of length one; false: nothing is left of it.
  const auto orthonormal = [&](Direction& d, const std::vector<const Direction*>& others) {
    const double before = mass_product(d.motion, d.motion);
    for (const Direction* other : others) d.add(-mass_product(d.motion, other->motion), *other);
    const double left = mass_product(d.motion, d.motion);
    if (!(left > 1e-20 * before)) return false;
    d.scale(1 / std::sqrt(left));
    return true;
  };
  x.scale(1 / std::sqrt(mass_product(x, x)));
  Direction mode{x, times(x)};
  std::optional<Direction> last;
  double lambda_before = std::numeric_limits<double>::infinity();
  for (long k = 1; k <= most; ++k) {
    const double lambda = mode.motion.dot(mode.force);
    if (k % at_once == 0) {
      if (lambda > lambda_before - change * std::fabs(lambda)) break;
      lambda_before = lambda;
    }
    Motion left = mode.force;
    for_elements(s_.topology_, [&](const TubeType& type, std::size_t i) {
      left.linear.add(i, -lambda * type.mass * mode.motion.linear[i]);
      left.angular.add(i, -lambda * type.inertia * mode.motion.angular[i]);
    });
    Direction down{s_.free_accelerations(left), left};
    down.force = times(down.motion);
    if (!orthonormal(down, {&mode})) break;
    std::vector<Direction*> basis{&mode, &down};
    if (last && orthonormal(*last, {&mode, &down})) basis.push_back(&*last);
    const auto size = static_cast<Eigen::Index>(basis.size());
    Eigen::MatrixXd matrix(size, size);
    for (Eigen::Index i = 0; i < size; ++i)
      for (Eigen::Index j = 0; j < size; ++j)
        matrix(i, j) = basis[static_cast<std::size_t>(i)]->motion.dot(basis[static_cast<std::size_t>(j)]->force);
    const Eigen::VectorXd part =
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(0.5 * (matrix + matrix.transpose())).eigenvectors().col(0);
    Direction next = down;
    next.scale(part[1]);
    if (size > 2) next.add(part[2], *last);
    mode.scale(part[0]);
    mode.add(1, next);
    last = next;
  }
  return mode.motion;
}

// Conjugate gradients for (K + s M) x = r. r is random, with unit variance in every mode: a symmetric state has no
// force along the motion that breaks its symmetry. The residual of a mode whose K is below -s M never falls, so
// that there is none once all of it is small. s keeps motions apart that cost nothing, such as the spin of a tube.
// Returns the softest mode, in the direction in which the energy falls farther, and that fall in eV.
std::optional<std::pair<Simulation::Motion, double>> Simulation::falling_motion(long most) const {
  constexpr double slowest = 1e-4;  // growth in a step that counts
  constexpr double small = 1e-4;    // squared part in a mode, 1 at first
  constexpr std::uint64_t seed = 1;
  const double shift = std::pow(slowest / part_step(), 2);
  const std::size_t n = state_.size();
  Motion left{Vec3Array(n), Vec3Array(n)};
  for_elements(topology_, [&](const TubeType& type, std::size_t i) {
    Eigen::Matrix<double, 6, 1> normal;
    for (std::uint32_t k = 0; k < 3; ++k) {
      const auto bits = philox({static_cast<std::uint32_t>(i), k, 0, 0}, seed);
      const auto pair = normal_pair(bits[0], bits[1]);
      normal.segment<2>(2 * k) << pair[0], pair[1];
    }
    left.linear.set(i, std::sqrt(type.mass) * normal.head<3>());
    left.angular.set(i, std::sqrt(type.inertia) * normal.tail<3>());
  });
  Stiffness stiffness(*this);
  Motion free = free_accelerations(left), along = free;
  double power = left.dot(free);
  for (long k = 0; k < most && power > small; ++k) {
    Motion resistance = stiffness.times(along);
    for_elements(topology_, [&](const TubeType& type, std::size_t i) {
      resistance.linear.add(i, shift * type.mass * along.linear[i]);
      resistance.angular.add(i, shift * type.inertia * along.angular[i]);
    });
    const double curvature = along.dot(resistance);
    if (curvature <= 0) {
      along = stiffness.softest_mode(along, most);
      Motion back = along;
      back.scale(-1);
      const double ahead = stiffness.fall_along(along), behind = stiffness.fall_along(back);
      if (ahead >= behind) return std::pair{along, ahead};
      return std::pair{back, behind};
    }
    left.add(-power / curvature, resistance);
    free = free_accelerations(left);
    const double next = left.dot(free);
    Motion turned = free;
    turned.add(next / power, along);
    along = turned;
    power = next;
  }
  return std::nullopt;
}

void Simulation::begin_relaxation(const RelaxGoal& goal) {
  relaxation_ = {};
  relaxation_.began = state_.step;
  relaxation_.goal = goal;
  relaxation_.first_energy = forces_.energy.potential() - account_.work;
  relaxation_.force = goal.force;
}

void Simulation::balance_relaxation() {
  account_.dissipated += relaxation_.constant - total_energy() + account_.supplied();
}

void Simulation::stand_still() {
  state_.velocity.set_to_zero();
  state_.angular_velocity.set_to_zero();
  balance_relaxation();
}

void Simulation::end_relaxation() {
  if (relaxation_.underway() && relaxation_.part_began >= 0) stand_still();
  relaxation_ = {};
}

bool Simulation::relax(double tolerance, long max_steps, const std::function<bool(long)>& progress) {
  sync_to_host();
  end_relaxation();
  begin_relaxation({tolerance, std::numeric_limits<double>::infinity()});
  const PartEnd end = relax_part(max_steps, progress);
  end_relaxation();
  return end == PartEnd::small_forces;
}

NewtonPace& Simulation::relaxation_with(const RelaxGoal& goal) {
  sync_to_host();
  if (!(relaxation_.goal == goal)) end_relaxation();
  if (!relaxation_.underway()) begin_relaxation(goal);
  return relaxation_.newton;
}

bool Simulation::relax_by_fire(double force, long most, const std::function<bool(long)>& progress) {
  ROPEWALK_EXPECTS(relaxation_.underway());
  relaxation_.force = force;
  return relax_part(most, progress) != PartEnd::interrupted;
}

void Simulation::displace(const Vec3Array& displacement, const Vec3Array& turn, double passes) {
  ROPEWALK_EXPECTS(relaxation_.underway() && relaxation_.part_began < 0 && passes >= 0);
  relaxation_.constant = total_energy() - account_.supplied();
  const double span = passes > 0 ? passes : 1;  // time of the motion, ps
  for (std::size_t i = 0; i < state_.size(); ++i) {
    state_.velocity.set(i, displacement[i] / span);
    state_.angular_velocity.set(i, turn[i] / span);
  }
  constrain(topology_, loads_, passes > 0 ? state_.time : before_all_motion, 0.5 * span, state_);
  const auto add_half_of_work = [&] {
    add_work(point_loads_, state_, 0.5 * span, account_, gauges_);
    if (passes > 0)
      add_work(reactions_at_rest(topology_, loads_, loaded_, forces_, state_), state_, 0.5 * span, account_,
               gauges_);
  };
  add_half_of_work();
  move(span);
  state_.time += passes;
  gauges_.follow(state_);
  ++state_.step;
  update_list();
  // Nothing is damped: such steps take no time.
  State way = state_;
  state_.velocity.set_to_zero();
  state_.angular_velocity.set_to_zero();
  compute(true, 0);
  std::swap(state_.velocity, way.velocity);
  std::swap(state_.angular_velocity, way.angular_velocity);
  add_half_of_work();
  if (passes > 0) gauges_.stand_at(state_.time);
  stand_still();
}

void Simulation::rest_after(const Relaxed& end) {
  end_relaxation();
  if (end.at_rest) rest_ = {state_.step, end.saddles, end.falls};
}

// If the forces are small and the energy is not, the forces have to become smaller.
Relaxed Simulation::relax(const RelaxGoal& goal, long max_steps, const std::function<bool(long)>& progress) {
  sync_to_host();
  ROPEWALK_EXPECTS(goal.force > 0 && goal.energy > 0 && max_steps >= 0);
  constexpr double least_part = 1e-3;  // this part of the contact energy stands for that of bonds that hardly bear
  constexpr double no_force = 1e-2;    // part of the goal: a state with less force that is no minimum is a saddle
  constexpr long least_iterations = 300;
  constexpr double least_fall = 1e-4;        // part of the energy of bonds and contact: less fall is not followed
  constexpr std::int64_t most_saddles = 30;  // couples of fixed direction have no potential: they may pump for ever
  Relaxation& r = relaxation_;
  if (!(r.goal == goal)) end_relaxation();
  if (!r.underway()) begin_relaxation(goal);
  // A motion that was tried starts from a higher energy.
  const auto refuse_rise = [&] {
    const double first = r.first_energy, risen = forces_.energy.potential() - account_.work - first;
    if (r.disturbances > 0 || !(risen > 1e-6 * (1 + std::fabs(first)))) return;
    end_relaxation();
    throw NumericalError(state_.step, -1, "the relaxation went up in energy, by " + std::to_string(risen) + " eV",
                         "start from a state without overlaps");
  };
  Relaxed out;
  for (;;) {
    out = {};
    const PartEnd end = relax_part(max_steps, progress);
    const bool small = end == PartEnd::small_forces;
    out.force = largest_force();
    if (end == PartEnd::interrupted) return out;
    const double bonds = std::max({forces_.energy.bonds(), least_part * std::fabs(forces_.energy.vdw), 1e-6});
    const double enough = 0.25 * goal.energy * goal.energy * bonds;
    const auto done = static_cast<long>(state_.step - r.began);
    if (out.force < goal.force) out.above = above_minimum(small ? enough : bonds, least_iterations + done);
    out.error = 2 * std::sqrt(out.above / bonds);
    const bool saddle = std::isinf(out.above) && out.force < no_force * goal.force;
    out.at_rest = small && (out.above <= enough || saddle);
    out.saddles = r.disturbances;
    if (!small) break;
    if (!out.at_rest) {
      r.force = out.force * (std::isfinite(out.above) ? std::max(0.01, 0.5 * std::sqrt(enough / out.above)) : 0.1);
      continue;
    }
    const double energy = forces_.energy.potential() - account_.work;
    if (r.disturbances == 0 && rest_.step == state_.step) {
      out.saddles = rest_.saddles;
      out.falls = rest_.falls;
      break;
    }
    // A disturbance from which it came back to the same energy was that of a minimum.
    if (r.disturbances > 0 && !(energy < r.disturbed_from - enough)) {
      --out.saddles;
      break;
    }
    if (r.disturbances == most_saddles) break;
    refuse_rise();
    const auto found = falling_motion(least_iterations + done);
    if (!found) break;
    const auto& [falling, fall] = *found;
    if (fall < least_fall * (forces_.energy.bonds() + std::fabs(forces_.energy.vdw))) {
      out.falls = fall;
      break;
    }
    ++r.disturbances;
    r.disturbed_from = energy;
    r.force = goal.force;
    state_.velocity = falling.linear;
    state_.angular_velocity = falling.angular;
    move_in_relaxation(Fire::farthest(topology_.largest_radius()) / farthest(falling));
    stand_still();
  }
  refuse_rise();
  end_relaxation();
  if (out.at_rest) rest_ = {state_.step, out.saddles, out.falls};
  return out;
}

// What turns as a rigid body moves along its chord, and so keeps its shape.
void Simulation::move_in_relaxation(double step) {
  constrain(topology_, loads_, state_.time, 0.5 * step, state_);
  add_work(point_loads_, state_, 0.5 * step, account_, gauges_);
  move(step);
  gauges_.follow(state_);
  ++state_.step;
  update_list();
  compute(true, 0);
  add_work(point_loads_, state_, 0.5 * step, account_, gauges_);
  balance_relaxation();
}

// `max_steps`: of the whole relaxation.
Simulation::PartEnd Simulation::relax_part(long max_steps, const std::function<bool(long)>& progress) {
  // One ratio for all tube types: it only weighs turning against moving.
  const TubeType& lightest = *std::min_element(topology_.types.begin(), topology_.types.end(),
                                               [](const auto& a, const auto& b) { return a.mass < b.mass; });
  const double scale2 = lightest.inertia / lightest.mass;
  const std::size_t n = state_.size();
  const double max_move = Fire::farthest(lightest.radius);
  Relaxation& r = relaxation_;
  Fire& fire = r.fire;
  if (r.part_began < 0) {
    r.part_began = state_.step;
    fire = Fire(part_step());
    r.constant = total_energy() - account_.supplied();
    stand_still();
    r.last_step = 0;
    r.longest_bond = std::max(2.0, 1.01 * longest_bond(topology_, state_.position).length);
  }
  ROPEWALK_EXPECTS(r.underway() && r.part_began >= r.began);
  while (state_.step - r.began < max_steps) {
    if ((state_.step - r.part_began) % Fire::check_every == 0) {
      const LongestBond longest = longest_bond(topology_, state_.position);
      if (longest.length > r.longest_bond)
        throw NumericalError(state_.step, longest.element,
                             "the relaxation blew up: it tore the bond to the next element",
                             "start from a state without overlaps, or with smaller loads");
      if (largest_force() < r.force) break;
    }
    if (!progress(static_cast<long>(state_.step - r.began))) return PartEnd::interrupted;
    double power = 0, v2 = 0, f2 = 0, fastest2 = 0;
    for (std::size_t i = 0; i < n; ++i)
      power += forces_.force[i].dot(state_.velocity[i]) + forces_.torque[i].dot(state_.angular_velocity[i]);
    if (power > 0) {
      fire.went_down();
    } else {
      constrain(topology_, loads_, state_.time, -0.25 * r.last_step, state_);
      add_work(point_loads_, state_, -0.5 * r.last_step, account_, gauges_);
      move(-0.5 * r.last_step);
      gauges_.follow(state_);
      stand_still();
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
    constrain(topology_, loads_, state_.time, 0.0, state_);
    for (std::size_t i = 0; i < n; ++i) {
      v2 += state_.velocity[i].squaredNorm() + scale2 * state_.angular_velocity[i].squaredNorm();
      f2 += forces_.force[i].squaredNorm() + forces_.torque[i].squaredNorm() / scale2;
    }
    if (!std::isfinite(v2 + f2))
      throw NumericalError(state_.step, not_finite(forces_), "relaxation met a force that is not finite",
                           "start from a state without overlaps");
    const double turn = f2 > 0 ? mix * std::sqrt(v2 / f2) : 0.0;
    for (std::size_t i = 0; i < n; ++i) {
      state_.velocity.set(i, (1 - mix) * state_.velocity[i] + turn * forces_.force[i]);
      state_.angular_velocity.set(i, (1 - mix) * state_.angular_velocity[i] + turn / scale2 * forces_.torque[i]);
    }
    constrain(topology_, loads_, state_.time, 0.0, state_);
    for (std::size_t i = 0; i < n; ++i)
      fastest2 =
          std::max(fastest2, state_.velocity[i].squaredNorm() + scale2 * state_.angular_velocity[i].squaredNorm());
    const double step = std::min(dt, fastest2 > 0 ? max_move / std::sqrt(fastest2) : dt);
    move_in_relaxation(step);
    r.last_step = step;
    if (forces_.slipping_bond >= 0) check_forces(true);
  }
  stand_still();
  r.part_began = -1;
  return largest_force() < r.force ? PartEnd::small_forces : PartEnd::out_of_steps;
}

}  // namespace ropewalk
