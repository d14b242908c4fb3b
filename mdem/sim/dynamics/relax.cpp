// Relaxation to a nearby minimum of the energy by FIRE (sim/dynamics/fire.hpp). Rotations take part with their
// angular velocities scaled by sqrt(I/m), so that both kinds of motion mix in one power.
#include <algorithm>
#include <cmath>

#include "model/error.hpp"
#include "sim/dynamics/fire.hpp"
#include "sim/dynamics/simulation.hpp"

namespace ropewalk {
namespace {

// The first element with a force or torque that is not finite; -1: none.
int not_finite(const Forces& f) {
  for (std::size_t i = 0; i < f.force.size(); ++i)
    if (!std::isfinite(f.force[i].squaredNorm() + f.torque[i].squaredNorm())) return static_cast<int>(i);
  return -1;
}

}  // namespace

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
  const double max_move = Fire::farthest(lightest.radius);
  for (long k = 0; k < max_steps; ++k) {
    if (k % Fire::check_every == 0 && largest_force() < tolerance) return true;
    if (!progress(k)) return false;
    double power = 0, v2 = 0, f2 = 0, fastest2 = 0;
    for (std::size_t i = 0; i < n; ++i)
      power += forces_.force[i].dot(state_.velocity[i]) + forces_.torque[i].dot(state_.angular_velocity[i]);
    if (power > 0) {
      fire.went_down();
    } else {
      if (k > 0) move(-0.5 * fire.dt);
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
      throw NumericalError(state_.step, not_finite(forces_), "relaxation met a force that is not finite",
                           "start from a state without overlaps");
    const double turn = f2 > 0 ? mix * std::sqrt(v2 / f2) : 0.0;
    for (std::size_t i = 0; i < n; ++i) {
      state_.velocity.set(i, (1 - mix) * state_.velocity[i] + turn * forces_.force[i]);
      state_.angular_velocity.set(i, (1 - mix) * state_.angular_velocity[i] + turn / scale2 * forces_.torque[i]);
    }
    constrain(topology_, loads_, state_.time, forces_, 0.0, state_);
    for (std::size_t i = 0; i < n; ++i)
      fastest2 =
          std::max(fastest2, state_.velocity[i].squaredNorm() + scale2 * state_.angular_velocity[i].squaredNorm());
    const double step = std::min(dt, fastest2 > 0 ? max_move / std::sqrt(fastest2) : dt);
    move(step);
    ++state_.step;
    update_list();
    compute();
    if (forces_.slipping_bond >= 0) check_forces(true);
  }
  return largest_force() < tolerance;
}

}  // namespace ropewalk
