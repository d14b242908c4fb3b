#include "sim/dynamics/loads.hpp"

#include <algorithm>
#include <cmath>

namespace ropewalk {
namespace {

Vector3 mean_position(const State& state, const std::vector<int>& elements) {
  Vector3 mean = Vector3::Zero();
  for (int e : elements) mean += state.position[static_cast<std::size_t>(e)];
  return mean / static_cast<double>(elements.size());
}

// Tangential forces about the grip's own centre, proportional to the arm, that add up to the moment.
void tangential_grip(const State& state, const std::vector<int>& grip, double moment, std::vector<PointLoad>& out) {
  const Vector3 centre = mean_position(state, grip);
  double arms2 = 0;
  for (int e : grip) {
    const Vector3 arm = state.position[static_cast<std::size_t>(e)] - centre;
    arms2 += arm.x() * arm.x() + arm.y() * arm.y();
  }
  if (arms2 <= 0) return;
  for (int e : grip) {
    const Vector3 arm = state.position[static_cast<std::size_t>(e)] - centre;
    out.push_back({e, moment / arms2 * Vector3(-arm.y(), arm.x(), 0), Vector3::Zero()});
  }
}

void twist_grip(const TwistDrive& twist, const State& state, const std::vector<int>& grip, double moment,
                std::vector<PointLoad>& out) {
  const double elements = static_cast<double>(grip.size());
  if (twist.tangential) {
    tangential_grip(state, grip, twist.per_tube ? moment * elements : moment, out);
    return;
  }
  const double each = twist.per_tube ? moment : moment / elements;
  for (int e : grip) out.push_back({e, Vector3::Zero(), Vector3(0, 0, each)});
}

void hold_grip(const TwistDrive& twist, const std::vector<int>& grip, State& state) {
  Vector3 mean = Vector3::Zero();
  for (int e : grip) mean += state.velocity[static_cast<std::size_t>(e)];
  mean /= static_cast<double>(grip.size());
  for (int e : grip) {
    const auto i = static_cast<std::size_t>(e);
    // Held sideways means that the rope's end stays on its axis while the tubes in it may turn about it.
    if (!twist.lateral_free) {
      state.velocity.x[i] -= mean.x();
      state.velocity.y[i] -= mean.y();
    }
    if (!twist.axial_free) state.velocity.z[i] = 0;
  }
}

void turn(const Turned& load, double time, std::size_t i, State& state) {
  const Vector3 omega(0, 0, load.speed(time));
  const Vector3 v = omega.cross(state.position[i] - load.centre);
  state.velocity.x[i] = v.x();
  state.velocity.y[i] = v.y();
  if (!load.axial_free) state.velocity.z[i] = 0;
  Vector3 w = omega;
  if (load.spin_free) {
    const Vector3 t = axis_of(state.orientation[i]);
    w += (state.angular_velocity[i] - omega).dot(t) * t;
  }
  state.angular_velocity.set(i, w);
}

}  // namespace

std::vector<int> driven_elements(const Drive& drive) {
  std::vector<int> all;
  visit_elements(drive, [&](int e) { all.push_back(e); });
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

void point_loads(const Drive& drive, const State& state, double time, std::vector<PointLoad>& out) {
  out = drive.loads;
  for (const TwistDrive& twist : drive.twist) {
    const double moment = twist.moment_at(time);
    twist_grip(twist, state, twist.upper, moment, out);
    twist_grip(twist, state, twist.lower, -moment, out);
  }
}

double load_power(const std::vector<PointLoad>& loads, const State& state) {
  double power = 0;
  for (const PointLoad& load : loads) {
    const auto i = static_cast<std::size_t>(load.element);
    power += load.force.dot(state.velocity[i]) + load.torque.dot(state.angular_velocity[i]);
  }
  return power;
}

double constrain(const Topology& topology, const Drive& drive, double time, const Forces& total, double kick,
                 State& state) {
  for (const TwistDrive& twist : drive.twist) {
    if (twist.lateral_free && twist.axial_free) continue;
    hold_grip(twist, twist.upper, state);
    hold_grip(twist, twist.lower, state);
  }
  for (const Fixed& f : drive.fixed) {
    const auto i = static_cast<std::size_t>(f.element);
    if (f.x) state.velocity.x[i] = 0;
    if (f.y) state.velocity.y[i] = 0;
    if (f.z) state.velocity.z[i] = 0;
    if (f.rotation) state.angular_velocity.set(i, Vector3::Zero());
  }
  // A turned element's kinetic energy is prescribed: what the other forces did not give, the constraint gave.
  double work = 0;
  for (const Turned& load : drive.turned)
    for (int e : load.elements) {
      const auto i = static_cast<std::size_t>(e);
      const TubeType& type = topology.type_of_element(e);
      const Vector3 dv = kick / type.mass * total.force[i], dw = kick / type.inertia * total.torque[i];
      const Vector3 v0 = state.velocity[i] - dv, w0 = state.angular_velocity[i] - dw;
      turn(load, time, i, state);
      const Vector3 v1 = state.velocity[i], w1 = state.angular_velocity[i];
      // Free components satisfy v1 - v0 = dv and drop out.
      work += 0.5 * type.mass * (v1 - v0 - dv).dot(v1 + v0) + 0.5 * type.inertia * (w1 - w0 - dw).dot(w1 + w0);
    }
  return work;
}

void relax_spins(const Topology& topology, State& state) {
  // The smallest rotation that carries axis t_i to t_j carries frame i to the twist-free frame j.
  const auto follow = [&](int from, int to) {
    const auto i = static_cast<std::size_t>(from), j = static_cast<std::size_t>(to);
    const Quaternion qi = state.orientation[i];
    const Quaternion carried = Quaternion::FromTwoVectors(axis_of(qi), axis_of(state.orientation[j])) * qi;
    state.orientation.set(j, carried.normalized());
  };
  for (int t = 0; t < topology.tubes(); ++t) {
    const int from = topology.tube_begin[t], to = topology.tube_begin[t + 1];
    const int middle = (from + to) / 2;
    for (int i = middle; i + 1 < to; ++i) follow(i, i + 1);
    for (int i = middle; i > from; --i) follow(i, i - 1);
    for (int e = from; e < to; ++e) {
      const auto i = static_cast<std::size_t>(e);
      const Vector3 axis = axis_of(state.orientation[i]);
      const Vector3 w = state.angular_velocity[i];
      state.angular_velocity.set(i, w - w.dot(axis) * axis);
    }
  }
}

}  // namespace ropewalk
