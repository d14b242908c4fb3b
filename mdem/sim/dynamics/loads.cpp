#include "sim/dynamics/loads.hpp"

#include <algorithm>

#include "model/contract.hpp"
#include "sim/dynamics/spins.hpp"

namespace ropewalk {

void Load::keep(const std::vector<std::size_t>& places, const LoadProcesses&) {
  elements = chosen(elements, places);
}

LoadEffect constant_effect(const Vector3& force, const Vector3& couple) {
  LoadEffect out;
  for (std::size_t k = 0; k < out.axes.size(); ++k) {
    const double value = k < 3 ? force[static_cast<Eigen::Index>(k)] : couple[static_cast<Eigen::Index>(k - 3)];
    if (value != 0) out.axes[k] = LoadComponent::follows(LoadComponent::Is::loaded, Schedule::always(value));
  }
  return out;
}

void LoadsAndConstraints::add(std::shared_ptr<const Load> load) {
  ROPEWALK_EXPECTS(load != nullptr);
  const auto behind =
      std::find_if(all_.begin(), all_.end(), [&](const auto& l) { return l->order() > load->order(); });
  all_.insert(behind, std::move(load));
}

double LoadsAndConstraints::spin_relaxation_interval() const {
  for (const auto& load : all_)
    if (load->spin_relaxation_interval() > 0) return load->spin_relaxation_interval();
  return 0;
}

std::vector<int> loaded_elements(const LoadsAndConstraints& loads) {
  std::vector<int> all;
  for (const auto& load : loads) all.insert(all.end(), load->elements.begin(), load->elements.end());
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

void point_loads(const LoadsAndConstraints& loads, const State& state, double time, std::vector<PointLoad>& out) {
  out.clear();
  for (const auto& load : loads) load->add_forces(state, time, out);
}

double load_power(const std::vector<PointLoad>& loads, const State& state) {
  double power = 0;
  for (const PointLoad& load : loads) {
    const auto i = static_cast<std::size_t>(load.element);
    power += load.force.dot(state.velocity[i]) + load.torque.dot(state.angular_velocity[i]);
  }
  return power;
}

void constrain(const Topology& topology, const LoadsAndConstraints& loads, double time, double ahead,
               State& state) {
  for (const auto& load : loads) load->constrain(topology, time, ahead, state);
}

// The velocity was v0, the other forces alone would have made it v0 + dv, and now it is v1: the constraint gave
// m (v1 - v0 - dv) at the mean velocity (v0 + v1)/2. The sum of all work is exact.
void constrain(const Topology& topology, const LoadsAndConstraints& loads, const std::vector<int>& elements,
               double time, double ahead, const Forces& total, double kick, State& state,
               std::vector<ConstraintImpulse>& out) {
  ROPEWALK_EXPECTS(total.force.size() == state.size() && std::is_sorted(elements.begin(), elements.end()));
  out.clear();
  for (const int e : elements) {
    const auto i = static_cast<std::size_t>(e);
    out.push_back({e, state.velocity[i], state.angular_velocity[i], 0});
  }
  for (const auto& load : loads) load->constrain_after(total, kick, topology, time, ahead, state);
  for (ConstraintImpulse& c : out) {
    const auto i = static_cast<std::size_t>(c.element);
    const TubeType& type = topology.type_of_element(c.element);
    const Vector3 v1 = state.velocity[i], w1 = state.angular_velocity[i];
    const Vector3 v0 = c.linear - kick / type.mass * total.force[i],
                  w0 = c.angular - kick / type.inertia * total.torque[i];
    c.linear = type.mass * (v1 - c.linear);
    c.angular = type.inertia * (w1 - c.angular);
    c.work = 0.5 * (c.linear.dot(v0 + v1) + c.angular.dot(w0 + w1));
  }
}

std::vector<ConstraintImpulse> reactions_at_rest(const Topology& topology, const LoadsAndConstraints& loads,
                                                 const std::vector<int>& elements, const Forces& total,
                                                 const State& state) {
  State accelerated = state;
  for (const int e : elements) {
    const auto i = static_cast<std::size_t>(e);
    const TubeType& type = topology.type_of_element(e);
    accelerated.velocity.set(i, total.force[i] / type.mass);
    accelerated.angular_velocity.set(i, total.torque[i] / type.inertia);
  }
  std::vector<ConstraintImpulse> out;
  constrain(topology, loads, elements, before_all_motion, 0, total, 0, accelerated, out);
  return out;
}

void relax_spins(const Topology& topology, State& state) {
  std::vector<char> known(state.size(), 0);
  for (const int i : middles_of_tubes(topology, topology)) known[static_cast<std::size_t>(i)] = 1;
  follow_spins(topology, known, state);
  take_spin_velocities_away(topology, state);
}

}  // namespace ropewalk
