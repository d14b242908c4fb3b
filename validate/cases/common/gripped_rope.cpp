#include "cases/common/gripped_rope.hpp"

#include <algorithm>
#include <cmath>

#include "scene/lattice.hpp"
#include "sim/contact/line/law.hpp"
#include "sim/contact/paper/law.hpp"

namespace ropewalk {

GrippedRope::GrippedRope(const ParameterSet& set, int bonds_, const std::string& law)
    : topology(topology_of(set)), bonds(bonds_) {
  if (law == "paper") {
    interaction.law = paper_law(*set.paper);
    spacing = pair_spacing(*set.paper, set.element_length);
  } else {
    interaction.law = line_law({line_contact_of(set)});
    spacing = line_parallel_well(set.line->density).distance;
  }
  const int elements = elements_of_tube();
  state = State(static_cast<std::size_t>(tubes * elements));
  for (const auto& [x, y] : hexagonal_lattice(tubes, spacing)) {
    const int first = topology.elements();
    topology.add_tube(elements);
    for (int e = 0; e < elements; ++e) {
      state.position.set(static_cast<std::size_t>(first + e),
                         {x, y, (e - 0.5 * (elements - 1)) * set.element_length});
      if (e < held) lower.push_back(first + e);
      if (e >= elements - held) upper.push_back(first + e);
    }
  }
}

double GrippedRope::fraction_at(int element) const {
  return std::clamp(static_cast<double>(element % elements_of_tube() - held + 1) / bonds, 0.0, 1.0);
}

void GrippedRope::hold_grips() {
  for (const int e : lower) loads.add(FixLoad({e}));
  for (const int e : upper) loads.add(FixLoad({e}));
}

void GrippedRope::turn(double angle) {
  for (int e = 0; e < topology.elements(); ++e) {
    const auto i = static_cast<std::size_t>(e);
    const Quaternion by = turn_about(Vector3::UnitZ(), turn_of(e, angle));
    state.position.set(i, by * state.position[i]);
    state.orientation.set(i, (by * state.orientation[i]).normalized());
  }
}

double torsion_energy(const BondStiffness& bond, double spacing, double length, double angle) {
  const double slope = spacing * angle / length, cos2 = 1 / (1 + slope * slope);
  return 0.5 * bond.twist * angle * angle / length * (1 + (GrippedRope::tubes - 1) * cos2);
}

double simpson_sum(const std::vector<double>& values, double distance) {
  double sum = values.front() + values.back();
  for (std::size_t k = 1; k + 1 < values.size(); ++k) sum += (k % 2 ? 4 : 2) * values[k];
  return sum * distance / 3;
}

}  // namespace ropewalk
