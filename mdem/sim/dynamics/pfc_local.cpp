#include "sim/dynamics/pfc_local.hpp"

#include <numeric>
#include <vector>

#include "model/damping.hpp"

namespace ropewalk {
namespace {

double kick_tube(const Topology& topology, int tube, double alpha, const Forces& forces, double dt, State& state) {
  const std::ptrdiff_t from = topology.tube_begin[tube], to = topology.tube_begin[tube + 1];
  const double per_mass = dt / topology.type_of(tube).mass, per_inertia = dt / topology.type_of(tube).inertia;
  double removed = 0;
  const auto push = [&](const Column& force, double inverse, Column& velocity) {
    for (std::ptrdiff_t i = from; i < to; ++i) {
      const double brake = pfc_local(alpha, force[i], velocity[i]);
      const double next = velocity[i] + inverse * (force[i] + brake);
      removed -= 0.5 * dt * brake * (velocity[i] + next);
      velocity[i] = next;
    }
  };
  push(forces.force.x, per_mass, state.velocity.x);
  push(forces.force.y, per_mass, state.velocity.y);
  push(forces.force.z, per_mass, state.velocity.z);
  push(forces.torque.x, per_inertia, state.angular_velocity.x);
  push(forces.torque.y, per_inertia, state.angular_velocity.y);
  push(forces.torque.z, per_inertia, state.angular_velocity.z);
  return removed;
}

}  // namespace

double kick_with_local_damping(const Topology& topology, double alpha, const Forces& forces, double dt,
                               State& state) {
  // Added up in the order of the tubes, whatever the threads.
  std::vector<double> removed(static_cast<std::size_t>(topology.tubes()));
#pragma omp parallel for schedule(static) if (state.size() > parallel_from)
  for (int t = 0; t < topology.tubes(); ++t)
    removed[static_cast<std::size_t>(t)] = kick_tube(topology, t, alpha, forces, dt, state);
  return std::accumulate(removed.begin(), removed.end(), 0.0);
}

}  // namespace ropewalk
