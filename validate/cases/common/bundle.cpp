#include "cases/common/bundle.hpp"

#include <limits>

#include "scene/lattice.hpp"
#include "sim/contact/line/law.hpp"

namespace ropewalk {

LineContact line_contact_of(const ParameterSet& set) {
  const LineDensity& density = set.line->density;
  const int nodes = line_nodes(set.element_length, line_parallel_well(density).distance, density.contact);
  return {density, set.element_length, set.element_length, nodes, nodes};
}

PairIntegral surface_integral(const ParameterSet& set) {
  const UniversalLine& atoms = set.line->universal;
  const AtomLaw law{atoms.epsilon, atoms.sigma,
                    atoms.lj_cutoff > 0 ? atoms.lj_cutoff : std::numeric_limits<double>::infinity()};
  const Shell shell{set.radius, set.line->surface_density};
  return PairIntegral(law, shell, shell);
}

Bundle line_bundle(const ParameterSet& set, int tubes, int elements) {
  Bundle b;
  b.topology = topology_of(set);
  b.interaction.law = line_law({line_contact_of(set)});
  b.spacing = line_parallel_well(set.line->density).distance;
  b.state = State(static_cast<std::size_t>(tubes * elements));
  std::size_t i = 0;
  for (const auto& [x, y] : hexagonal_lattice(tubes, b.spacing)) {
    b.topology.add_tube(elements);
    for (int e = 0; e < elements; ++e)
      b.state.position.set(i++, {x, y, (e - 0.5 * (elements - 1)) * set.element_length});
  }
  b.time_step = default_step_fraction * time_step_limit(b.topology, b.interaction, b.spacing).limit;
  return b;
}

double resisting_moment(const std::vector<int>& elements, const Vec3Array& position, const Vec3Array& force,
                        const Vec3Array& torque) {
  double sum = 0;
  for (const int e : elements) {
    const auto i = static_cast<std::size_t>(e);
    sum -= torque.z[i] + position.x[i] * force.y[i] - position.y[i] * force.x[i];
  }
  return sum;
}

}  // namespace ropewalk
