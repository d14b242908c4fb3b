#include "sim/dynamics/gauges.hpp"

#include <cmath>
#include <limits>

#include "model/contract.hpp"
#include "model/units.hpp"

namespace ropewalk {
namespace {}  // namespace

EndElements tube_ends(const Topology& topology) {
  EndElements ends;
  for (int t = 0; t < topology.tubes(); ++t) {
    if (topology.begins_strand(t)) ends[lower_end].push_back(topology.tube_begin[t]);
    if (topology.ends_strand(t)) ends[upper_end].push_back(topology.tube_begin[t + 1] - 1);
  }
  return ends;
}

Vector3 centre_of(const Topology& topology, const State& state, const std::vector<int>& elements) {
  Vector3 sum = Vector3::Zero();
  double mass = 0;
  for (const int e : elements) {
    const double m = topology.type_of_element(e).mass;
    sum += m * state.position[static_cast<std::size_t>(e)];
    mass += m;
  }
  return mass > 0 ? Vector3(sum / mass) : sum;
}

Gauges::Gauges(const Topology& topology, EndElements ends, const State& start)
    : ends_(std::move(ends)), end_of_(static_cast<std::size_t>(topology.elements()), -1) {
  sums.since = start.time;
  for (const End end : {lower_end, upper_end})
    for (const int e : ends_[end]) {
      end_of_[static_cast<std::size_t>(e)] = static_cast<signed char>(end);
      mass_[end].push_back(topology.type_of_element(e).mass);
    }
  locate(start);
  for (const End end : {lower_end, upper_end})
    for (std::size_t k = 0; k < ends_[end].size(); ++k) arm_[end].push_back(arm_now(start, end, k));
}

Vector3 Gauges::arm_now(const State& state, std::size_t end, std::size_t k) const {
  const auto i = static_cast<std::size_t>(ends_[end][k]);
  if (ends_[end].size() == 1) return frame_of(state.orientation[i]).e1;
  return state.position[i] - centre_[end];
}

void Gauges::locate(const State& state) {
  for (const End end : {lower_end, upper_end}) {
    centre_[end] = Vector3::Zero();
    double mass = 0;
    for (std::size_t k = 0; k < ends_[end].size(); ++k) {
      centre_[end] += mass_[end][k] * state.position[static_cast<std::size_t>(ends_[end][k])];
      mass += mass_[end][k];
    }
    if (mass > 0) centre_[end] /= mass;
  }
}

void Gauges::add(const State& state, int element, const Vector3& force, const Vector3& torque, double work) {
  ROPEWALK_EXPECTS(element >= 0 && static_cast<std::size_t>(element) < end_of_.size());
  const auto i = static_cast<std::size_t>(element);
  if (end_of_[i] < 0) return;
  const auto end = static_cast<std::size_t>(end_of_[i]);
  Sum& sum = sums.of[end];
  sum.force_time = vec_sum(sum.force_time, plain(force));
  sum.torque_time = vec_sum(sum.torque_time, plain(torque + (state.position[i] - centre_[end]).cross(force)));
  sum.work += work;
}

void Gauges::add_loads(const State& state, const std::vector<PointLoad>& loads, double dt) {
  if (loads.empty() || end_of_.empty()) return;
  locate(state);
  for (const PointLoad& l : loads) {
    const auto i = static_cast<std::size_t>(l.element);
    add(state, l.element, dt * l.force, dt * l.torque,
        dt * (l.force.dot(state.velocity[i]) + l.torque.dot(state.angular_velocity[i])));
  }
}

void Gauges::add_constraints(const State& state, const std::vector<ConstraintImpulse>& impulses) {
  if (impulses.empty() || end_of_.empty()) return;
  locate(state);
  for (const ConstraintImpulse& c : impulses) add(state, c.element, c.linear, c.angular, c.work);
}

void Gauges::follow(const State& state) {
  if (end_of_.empty()) return;
  locate(state);
  for (const End end : {lower_end, upper_end}) {
    double cross = 0, dot = 0;
    for (std::size_t k = 0; k < ends_[end].size(); ++k) {
      const Vector3 a = arm_[end][k], b = arm_now(state, end, k);
      cross += mass_[end][k] * (a.x() * b.y() - a.y() * b.x());
      dot += mass_[end][k] * (a.x() * b.x() + a.y() * b.y());
    }
    double& turned = sums.of[end].turned;
    turned += std::remainder(std::atan2(cross, dot) - turned, 2 * units::pi);
  }
}

void Gauges::forget_work() {
  for (Sum& sum : sums.of) sum.work = std::numeric_limits<double>::quiet_NaN();
}

EndReadings Gauges::read(const State& state) {
  ROPEWALK_EXPECTS(state.time > sums.since);
  EndReadings out;
  const double time = state.time - sums.since;
  for (const End end : {lower_end, upper_end}) {
    Sum& sum = sums.of[end];
    out[end] = {vector(sum.force_time) / time, vector(sum.torque_time) / time, sum.turned, sum.work};
    sum.force_time = sum.torque_time = {};
  }
  sums.since = state.time;
  return out;
}

// As sums over one picosecond.
EndReadings Gauges::read_still(const State& state, const std::vector<ConstraintImpulse>& reactions,
                               const std::vector<PointLoad>& loads) {
  const Sums kept = sums;
  for (Sum& sum : sums.of) sum.force_time = sum.torque_time = {};
  add_constraints(state, reactions);
  add_loads(state, loads, 1);
  EndReadings out;
  for (const End end : {lower_end, upper_end}) {
    const Sum& sum = sums.of[end];
    out[end] = {vector(sum.force_time), vector(sum.torque_time), kept.of[end].turned, kept.of[end].work};
  }
  sums = kept;
  return out;
}

}  // namespace ropewalk
