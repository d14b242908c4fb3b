// Relaxation to a nearby minimum of the energy by FIRE (sim/dynamics/fire.hpp). Rotations take part with their
// angular velocities scaled by sqrt(I/m), so that both kinds of motion mix in one power.
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "model/contract.hpp"
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
  double length = 0;  // of the element's
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

// F.K^-1.F/2 by conjugate gradients, with masses as the preconditioner and K times a motion from the difference of
// two forces, in double. It grows with the iterations: one that is more than `enough` (eV) is returned as it is. M.
// R. Hestenes, E. Stiefel, J. Res. Natl. Bur. Stand. 49, 409 (1952), DOI 10.6028/jres.049.044: the
// rest is estimated by the sum of the last iterations. Infinite where K is not positive or `most` iterations are
// too few.
double Simulation::above_minimum(double enough, long most) const {
  constexpr double unknown = std::numeric_limits<double>::infinity();
  constexpr double step = 1e-4;  // nm: less, and rounding hides the soft motions
  Interaction in = interaction_;
  in.precision = Interaction::Precision::full;
  ForceEngine engine;
  engine.take_terms_of(engine_);
  const auto n = static_cast<std::ptrdiff_t>(state_.size());
  std::vector<PointLoad> loads;
  const auto forces_after = [&](const Motion& motion, double time) {
    State s = state_;
    s.velocity = motion.linear;
    s.angular_velocity = motion.angular;
    move_elements(s, time, 0, n);
    s.velocity = s.angular_velocity = Vec3Array(state_.size());
    Forces f(state_.size());
    engine.compute(topology_, in, list_, s, f, {Parts::all, false});
    point_loads(loads_, s, s.time, loads);
    Motion forces{f.force, f.torque};
    for (const PointLoad& load : loads) {
      forces.linear.add(static_cast<std::size_t>(load.element), load.force);
      forces.angular.add(static_cast<std::size_t>(load.element), load.torque);
    }
    return forces;
  };
  const Motion at_rest = forces_after({Vec3Array(state_.size()), Vec3Array(state_.size())}, 0);
  Motion left = at_rest, free = free_accelerations(left), along = free;
  double power = left.dot(free), above = 0;
  const double first = power;
  std::vector<double> sums{0};
  long fewest = 30;  // an iteration reaches the next element of a tube
  for (int t = 0; t < topology_.tubes(); ++t) fewest = std::max(fewest, 3L * topology_.length_of(t));
  for (long k = 1; k <= most + fewest && power > 0; ++k) {
    double farthest = 0;
    for (std::size_t i = 0; i < state_.size(); ++i)
      farthest = std::max({farthest, along.linear[i].norm(), topology_.largest_radius() * along.angular[i].norm()});
    Motion resistance = forces_after(along, step / farthest);  // the forces fall by K times the motion
    resistance.add(-1, at_rest);
    const double stiffness = -along.dot(resistance) * farthest / step;
    if (!(stiffness > 0)) return unknown;
    const double by = power / stiffness;
    above += 0.5 * by * power;
    sums.push_back(above);
    const auto before = static_cast<std::size_t>(std::min(k, std::max(15L, k / 2)));
    const double lately = above - sums[sums.size() - 1 - before];
    if (above > enough) return above;
    if (k >= fewest && lately < 0.05 * above) return above + lately;
    left.add(by * farthest / step, resistance);
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
  end_relaxation();
  begin_relaxation({tolerance, std::numeric_limits<double>::infinity()});
  const PartEnd end = relax_part(max_steps, progress);
  end_relaxation();
  return end == PartEnd::small_forces;
}

// If the forces are small and the energy is not, the forces have to become smaller.
Relaxed Simulation::relax(const RelaxGoal& goal, long max_steps, const std::function<bool(long)>& progress) {
  ROPEWALK_EXPECTS(goal.force > 0 && goal.energy > 0 && max_steps >= 0);
  constexpr double least_part = 1e-3;  // of the contact's energy, which stands for that of bonds that hardly bear
  constexpr double no_force = 1e-2;    // of the goal: what rests here without a minimum rests on a saddle
  constexpr long least_iterations = 300;
  Relaxation& r = relaxation_;
  if (!(r.goal == goal)) end_relaxation();
  if (!r.underway()) begin_relaxation(goal);
  Relaxed out;
  for (;;) {
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
    if (out.at_rest || !small) break;
    r.force = out.force * (std::isfinite(out.above) ? std::max(0.01, 0.5 * std::sqrt(enough / out.above)) : 0.1);
  }
  const double first = r.first_energy, risen = forces_.energy.potential() - account_.work - first;
  end_relaxation();
  if (risen > 1e-6 * (1 + std::fabs(first)))
    throw NumericalError(state_.step, -1, "the relaxation went up in energy, by " + std::to_string(risen) + " eV",
                         "start from a state without overlaps");
  return out;
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
  ROPEWALK_ENSURES(r.underway() && r.part_began >= r.began);
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
      account_.work -= 0.5 * r.last_step * load_power(point_loads_, state_);
      move(-0.5 * r.last_step);
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
    account_.work += 0.5 * step * load_power(point_loads_, state_);
    move(step);
    r.last_step = step;
    ++state_.step;
    update_list();
    compute(true, 0);
    account_.work += 0.5 * step * load_power(point_loads_, state_);
    balance_relaxation();
    if (forces_.slipping_bond >= 0) check_forces(true);
  }
  stand_still();
  r.part_began = -1;
  return largest_force() < r.force ? PartEnd::small_forces : PartEnd::out_of_steps;
}

}  // namespace ropewalk
