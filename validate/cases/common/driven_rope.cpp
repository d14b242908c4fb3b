#include "cases/common/driven_rope.hpp"

#include <utility>

#include "scene/maxwell.hpp"

namespace ropewalk::validate {

DrivenRope::DrivenRope(const ParameterSet& set, int bonds, Bonds kind, double step_fraction, double brake)
    : rope_(gripped_rope(set, bonds)),
      kind_(kind),
      time_step_(step_fraction * time_step_limit(rope_.topology, rope_.interaction, rope_.spacing).limit),
      brake_(brake),
      forces_(rope_.state.size()),
      bond_(rope_.state.size(), ParallelBond(set.bond, set.element_length)),
      start_(rope_.state.position),
      move_(rope_.state.size()) {
  // The contact is the simulator's; bonds without stiffness exert no force.
  if (kind_ == Bonds::incremental) rope_.topology.types[0].bond = {};
  list_ = NeighbourList(rope_.interaction, default_skin(rope_.interaction));
  list_.build(rope_.topology, rope_.state);
  forces();
}

void DrivenRope::rest(double duration) {
  move([this](double) { return place_; }, duration);
}

void DrivenRope::shake(double temperature, std::uint64_t seed, double duration) {
  Random random(seed);
  set_thermal_velocities(rope_.topology, 2 * temperature, random, rope_.state);
  const double brake = std::exchange(brake_, 0.0);
  rest(duration);
  brake_ = brake;
}

void DrivenRope::forces() {
  list_.update(rope_.topology, rope_.state);
  engine_.compute(rope_.topology, rope_.interaction, list_, rope_.state, forces_);
  bonds_ = forces_.energy.bonds();
  twist_ = forces_.energy.twist;
  contact_ = forces_.energy.vdw;
  if (kind_ == Bonds::incremental) add_incremental();
  Vec3Array arm = rope_.state.position;
  for (const int e : rope_.upper) arm.add(static_cast<std::size_t>(e), -place_.shift);
  moment_ = resisting_moment(rope_.upper, arm, forces_.force, forces_.torque);
}

void DrivenRope::add_incremental() {
  const Topology& topology = rope_.topology;
  for (int t = 0; t < topology.tubes(); ++t)
    for (int e = topology.tube_begin[t]; e + 1 < topology.tube_begin[t + 1]; ++e) {
      const auto i = static_cast<std::size_t>(e), j = i + 1;
      const Vector3 separation = rope_.state.position[j] - rope_.state.position[i];
      const Vector3 lever = -0.5 * separation.cross(bond_[i].force());
      forces_.force.add(i, -bond_[i].force());
      forces_.force.add(j, bond_[i].force());
      forces_.torque.add(i, lever - bond_[i].moment());
      forces_.torque.add(j, lever + bond_[i].moment());
      bonds_ += bond_[i].energy(separation);
    }
}

void DrivenRope::step(const GripPlace& place) {
  State& s = rope_.state;
  const TubeType& type = rope_.topology.types[0];
  const Vec3Array before = s.position;
  const double keep = 1 - brake_ * time_step_;
  for (std::size_t i = 0; i < s.size(); ++i) {
    s.velocity.set(i, keep * s.velocity[i] + time_step_ / type.mass * forces_.force[i]);
    s.angular_velocity.set(i, keep * s.angular_velocity[i] + time_step_ / type.inertia * forces_.torque[i]);
    move_[i] = {time_step_ * s.velocity[i], time_step_ * s.angular_velocity[i]};
  }
  for (const int e : rope_.lower) move_[static_cast<std::size_t>(e)] = {};
  const Quaternion turned = turn_about(Vector3::UnitZ(), place.angle);
  for (const int e : rope_.upper) {
    const auto i = static_cast<std::size_t>(e);
    move_[i] = {place.shift + turned * start_[i] - s.position[i], {0, 0, place.angle - place_.angle}};
  }
  for (std::size_t i = 0; i < s.size(); ++i) {
    s.position.add(i, move_[i].shift);
    s.orientation.set(i, (small_turn(move_[i].turn) * s.orientation[i]).normalized());
  }
  for (const auto* grip : {&rope_.lower, &rope_.upper})
    for (const int e : *grip) {
      s.velocity.set(static_cast<std::size_t>(e), Vector3::Zero());
      s.angular_velocity.set(static_cast<std::size_t>(e), Vector3::Zero());
    }
  place_ = place;
  if (kind_ == Bonds::incremental)
    for (int t = 0; t < rope_.topology.tubes(); ++t)
      for (int e = rope_.topology.tube_begin[t]; e + 1 < rope_.topology.tube_begin[t + 1]; ++e) {
        const auto i = static_cast<std::size_t>(e), j = i + 1;
        bond_[i].advance(before[j] - before[i], s.position[j] - s.position[i], move_[i], move_[j]);
      }
  forces();
}

}  // namespace ropewalk::validate
