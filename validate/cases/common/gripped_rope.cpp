#include "cases/common/gripped_rope.hpp"

#include <algorithm>
#include <cmath>

#include "scene/lattice.hpp"
#include "sim/contact/line/law.hpp"

namespace ropewalk::validate {

GrippedRope::GrippedRope(const ParameterSet& set, int bonds_, std::shared_ptr<const ContactLaw> law,
                         double spacing_, int held_)
    : bonds(bonds_), held(held_), spacing(spacing_) {
  interaction.law = std::move(law);
  const int elements = elements_of_tube();
  BuiltScene rope = straight_tubes(set, elements, hexagonal_lattice(tubes, spacing));
  topology = std::move(rope.topology);
  state = std::move(rope.state);
  for (int i = 0; i < topology.elements(); ++i) {
    if (i % elements < held) lower.push_back(i);
    if (i % elements >= elements - held) upper.push_back(i);
  }
}

double GrippedRope::fraction_at(int element) const {
  return std::clamp(static_cast<double>(element % elements_of_tube() - held + 1) / bonds, 0.0, 1.0);
}

void GrippedRope::turn(double angle) {
  for (int e = 0; e < topology.elements(); ++e) {
    const auto i = static_cast<std::size_t>(e);
    const Quaternion by = turn_about(Vector3::UnitZ(), (fraction_at(e) - 0.5) * angle);
    state.position.set(i, by * state.position[i]);
    state.orientation.set(i, (by * state.orientation[i]).normalized());
  }
}

void GrippedRope::relax(double tolerance) {
  constexpr double step_fraction = 0.9;  // of the stability limit: nothing has to be conserved
  LoadsAndConstraints grips;
  for (const auto* grip : {&lower, &upper})
    for (const int e : *grip) grips.add(FixLoad({e}));
  const double step = step_fraction * time_step_limit(topology, interaction, spacing).limit;
  const Simulation rest = at_rest(Simulation(topology, interaction, grips, state, step), tolerance, 100000);
  state = rest.state();
  forces = rest.forces();
}

double GrippedRope::moment() const { return resisting_moment(upper, state.position, forces.force, forces.torque); }

}  // namespace ropewalk::validate
