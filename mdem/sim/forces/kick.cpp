#include "sim/forces/kick.hpp"

#include "sim/state/motion.hpp"

namespace ropewalk {

double kick(const Topology& topology, const ForceTerms* terms, const ForceRows& total, double dt, const Segment& of,
            State& state) {
  const TubeType& type = topology.type_of(of.tube);
  const double per_mass = dt / type.mass, per_inertia = dt / type.inertia;
  if (!terms) {
    kick_elements(total.force, per_mass, state.velocity, of.begin, of.end);
    kick_elements(total.torque, per_inertia, state.angular_velocity, of.begin, of.end);
    return 0;
  }
  thread_local Vec3Array force, torque;
  for (Vec3Array* v : {&force, &torque}) {
    v->resize(static_cast<std::size_t>(of.end - of.begin));
    v->set_to_zero();
  }
  terms->add_in_kick(state, total, of, {force, torque, of.begin});
  double removed = 0;
  const auto push = [&](const Column& others, const Column& own, double inverse, Column& velocity) {
    for (std::ptrdiff_t i = of.begin; i < of.end; ++i) {
      const double more = own[i - of.begin], next = velocity[i] + inverse * (others[i] + more);
      removed -= 0.5 * dt * more * (velocity[i] + next);
      velocity[i] = next;
    }
  };
  push(total.force.x, force.x, per_mass, state.velocity.x);
  push(total.force.y, force.y, per_mass, state.velocity.y);
  push(total.force.z, force.z, per_mass, state.velocity.z);
  push(total.torque.x, torque.x, per_inertia, state.angular_velocity.x);
  push(total.torque.y, torque.y, per_inertia, state.angular_velocity.y);
  push(total.torque.z, torque.z, per_inertia, state.angular_velocity.z);
  return removed;
}

}  // namespace ropewalk
