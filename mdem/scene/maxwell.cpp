#include "scene/maxwell.hpp"

#include <Eigen/LU>
#include <cmath>

#include "sim/forces.hpp"

namespace ropewalk {
namespace {

Vector3 centre_of_mass(const State& state) {
  Vector3 sum = Vector3::Zero();
  for (std::size_t i = 0; i < state.size(); ++i) sum += state.position[i];
  return sum / static_cast<double>(state.size());
}

// Of all elements about their centre of mass; never singular, since every element has inertia of its own.
Eigen::Matrix3d inertia_tensor(const Topology& topology, const State& state) {
  const Vector3 centre = centre_of_mass(state);
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < state.size(); ++i) {
    const Vector3 r = state.position[i] - centre;
    sum += (topology.inertia + topology.mass * r.squaredNorm()) * Eigen::Matrix3d::Identity();
    sum -= topology.mass * r * r.transpose();
  }
  return sum;
}

Vector3 normal_vector(Random& random, double width) {
  const double x = random.normal(), y = random.normal(), z = random.normal();
  return width * Vector3(x, y, z);
}

void remove_momenta(const Topology& topology, State& state) {
  const Momenta net = net_momenta(topology, state);
  const Vector3 drift = net.linear / (topology.mass * static_cast<double>(state.size()));
  const Vector3 spin = inertia_tensor(topology, state).inverse() * net.angular;
  const Vector3 centre = centre_of_mass(state);
  for (std::size_t i = 0; i < state.size(); ++i) {
    state.velocity.add(i, -drift - spin.cross(state.position[i] - centre));
    state.angular_velocity.add(i, -spin);
  }
}

void scale(State& state, double factor) {
  for (std::size_t i = 0; i < state.size(); ++i) {
    state.velocity.set(i, factor * state.velocity[i]);
    state.angular_velocity.set(i, factor * state.angular_velocity[i]);
  }
}

}  // namespace

Momenta net_momenta(const Topology& topology, const State& state) {
  const Vector3 centre = centre_of_mass(state);
  Momenta net;
  for (std::size_t i = 0; i < state.size(); ++i) {
    net.linear += topology.mass * state.velocity[i];
    net.angular += topology.mass * (state.position[i] - centre).cross(state.velocity[i]) +
                   topology.inertia * state.angular_velocity[i];
  }
  return net;
}

void set_thermal_velocities(const Topology& topology, double temperature, Random& random, State& state) {
  const double kT = units::boltzmann * temperature;
  for (std::size_t i = 0; i < state.size(); ++i) {
    state.velocity.set(i, normal_vector(random, std::sqrt(kT / topology.mass)));
    state.angular_velocity.set(i, normal_vector(random, std::sqrt(kT / topology.inertia)));
  }
  remove_momenta(topology, state);
  scale(state, std::sqrt(0.5 * thermal_freedoms(state) * kT / kinetic_energy(topology, state)));
}

}  // namespace ropewalk
