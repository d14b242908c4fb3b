#include "scene/maxwell.hpp"

#include <Eigen/LU>
#include <cmath>

#include "sim/forces/forces.hpp"

namespace ropewalk {
namespace {

template <class F>
void for_each_element(const Topology& topology, F f) {
  for (int t = 0; t < topology.tubes(); ++t)
    for (int e = topology.tube_begin[t]; e < topology.tube_begin[t + 1]; ++e)
      f(static_cast<std::size_t>(e), topology.type_of(t));
}

double total_mass(const Topology& topology) {
  double sum = 0;
  for_each_element(topology, [&](std::size_t, const TubeType& type) { sum += type.mass; });
  return sum;
}

Vector3 centre_of_mass(const Topology& topology, const State& state) {
  Vector3 sum = Vector3::Zero();
  for_each_element(topology, [&](std::size_t i, const TubeType& type) { sum += type.mass * state.position[i]; });
  return sum / total_mass(topology);
}

// The inertia of all elements about their centre of mass; never singular, since every element has inertia of its
// own.
Eigen::Matrix3d inertia_tensor(const Topology& topology, const State& state) {
  const Vector3 centre = centre_of_mass(topology, state);
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for_each_element(topology, [&](std::size_t i, const TubeType& type) {
    const Vector3 r = state.position[i] - centre;
    sum += (type.inertia + type.mass * r.squaredNorm()) * Eigen::Matrix3d::Identity();
    sum -= type.mass * r * r.transpose();
  });
  return sum;
}

Vector3 normal_vector(Random& random, double width) {
  const double x = random.normal(), y = random.normal(), z = random.normal();
  return width * Vector3(x, y, z);
}

void remove_momenta(const Topology& topology, State& state) {
  const Momenta net = net_momenta(topology, state);
  const Vector3 drift = net.linear / total_mass(topology);
  const Vector3 spin = inertia_tensor(topology, state).inverse() * net.angular;
  const Vector3 centre = centre_of_mass(topology, state);
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
  const Vector3 centre = centre_of_mass(topology, state);
  Momenta net;
  for_each_element(topology, [&](std::size_t i, const TubeType& type) {
    net.linear += type.mass * state.velocity[i];
    net.angular += type.mass * (state.position[i] - centre).cross(state.velocity[i]) +
                   type.inertia * state.angular_velocity[i];
  });
  return net;
}

void set_thermal_velocities(const Topology& topology, double temperature, Random& random, State& state) {
  const double kT = units::boltzmann * temperature;
  for_each_element(topology, [&](std::size_t i, const TubeType& type) {
    state.velocity.set(i, normal_vector(random, std::sqrt(kT / type.mass)));
    state.angular_velocity.set(i, normal_vector(random, std::sqrt(kT / type.inertia)));
  });
  remove_momenta(topology, state);
  scale(state, std::sqrt(0.5 * thermal_freedoms(state) * kT / kinetic_energy(topology, state)));
}

}  // namespace ropewalk
