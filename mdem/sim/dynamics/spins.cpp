#include "sim/dynamics/spins.hpp"

#include <cmath>

#include "sim/state/part_of_scene.hpp"

namespace ropewalk {

bool relaxes_spins_at(double time, double step, double interval) {
  if (!(interval > 0)) return false;
  const auto increments = [&](double at) { return std::floor(at / interval + 1e-9); };
  return increments(time) != increments(time - step);
}

std::vector<int> middles_of_tubes(const Topology& scene, const Topology& here) {
  std::vector<int> middles;
  for (int t = 0; t < scene.tubes(); ++t) {
    const int place = place_of(here, (scene.tube_begin[t] + scene.tube_begin[t + 1]) / 2);
    if (place >= 0 && here.owns(place)) middles.push_back(place);
  }
  return middles;
}

std::vector<int> follow_spins(const Topology& topology, std::vector<char>& known, State& state) {
  std::vector<int> followed;
  // The smallest rotation that carries axis t_i to t_j carries frame i to the twist-free frame j.
  const auto follow = [&](int from, int to) {
    const auto i = static_cast<std::size_t>(from), j = static_cast<std::size_t>(to);
    if (!known[i] || known[j] || !topology.owns(to)) return;
    const Quaternion qi = state.orientation[i];
    const Quaternion carried = Quaternion::FromTwoVectors(axis_of(qi), axis_of(state.orientation[j])) * qi;
    state.orientation.set(j, carried.normalized());
    known[j] = 1;
    followed.push_back(to);
  };
  for (int t = 0; t < topology.tubes(); ++t) {
    const int from = topology.tube_begin[t], to = topology.tube_begin[t + 1];
    for (int i = from; i + 1 < to; ++i) follow(i, i + 1);
    for (int i = to - 1; i > from; --i) follow(i, i - 1);
  }
  return followed;
}

void take_spin_velocities_away(const Topology& topology, State& state) {
  for (int e = 0; e < topology.elements(); ++e) {
    if (!topology.owns(e)) continue;
    const auto i = static_cast<std::size_t>(e);
    const Vector3 axis = axis_of(state.orientation[i]);
    const Vector3 w = state.angular_velocity[i];
    state.angular_velocity.set(i, w - w.dot(axis) * axis);
  }
}

}  // namespace ropewalk
