#include "cases/common/gripped_rope.hpp"

#include <algorithm>
#include <cmath>

#include "scene/kinds/scene_kind.hpp"
#include "scene/lattice.hpp"
#include "sim/contact/line/law.hpp"

namespace ropewalk::validate {

GrippedRope::GrippedRope(const ParameterSet& set, int bonds_, std::shared_ptr<const ContactLaw> law,
                         double spacing_, int held_)
    : topology(topology_of(set)), bonds(bonds_), held(held_), spacing(spacing_) {
  interaction.law = std::move(law);
  const int elements = elements_of_tube();
  add_straight_tubes(hexagonal_lattice(tubes, spacing), elements, set.element_length, topology, state);
  for (int i = 0; i < topology.elements(); ++i) {
    if (i % elements < held) lower.push_back(i);
    if (i % elements >= elements - held) upper.push_back(i);
  }
}

GrippedRope gripped_rope(const ParameterSet& set, int bonds) {
  return {set, bonds, line_law({line_contact_of(set)}), line_parallel_well(set.line->density).distance};
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
    for (const int e : *grip) grips.add(FixLoad({e}, true, true, true, holds_orientations));
  const double step = step_fraction * time_step_limit(topology, interaction, spacing).limit;
  const Simulation rest = at_rest(Simulation(topology, interaction, grips, state, step), tolerance, 100000);
  state = rest.state();
  forces = rest.forces();
}

double GrippedRope::moment() const { return resisting_moment(upper, state.position, forces.force, forces.torque); }

double torsion_energy(const BondStiffness& bond, double spacing, double length, double angle) {
  const double slope = spacing * angle / length, cos2 = 1 / (1 + slope * slope);
  return 0.5 * bond.twist * angle * angle / length * (1 + (GrippedRope::tubes - 1) * cos2);
}

double simpson_sum(const std::vector<double>& values, double distance) {
  double sum = values.front() + values.back();
  for (std::size_t k = 1; k + 1 < values.size(); ++k) sum += (k % 2 ? 4 : 2) * values[k];
  return sum * distance / 3;
}

}  // namespace ropewalk::validate
