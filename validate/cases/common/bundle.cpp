#include "cases/common/bundle.hpp"

#include <cmath>
#include <limits>

#include "model/contact/line_parameters.hpp"
#include "scene/lattice.hpp"
#include "sim/contact/line/law.hpp"

namespace ropewalk::validate {

LineContact line_contact_of(const ParameterSet& set) {
  const LineDensity& density = set.law<LineParameters>()->density;
  const int nodes = line_nodes(set.element_length, line_parallel_well(density).distance, density.contact);
  return {density, set.element_length, set.element_length, nodes, nodes};
}

WallsIntegral surface_integral(const ParameterSet& set) {
  if (set.filament)
    throw NotApplicable("the oracle is the surface integral over the atoms of two tubes, and a filament has none");
  const UniversalLine& atoms = set.law<LineParameters>()->universal;
  const AtomLaw law{atoms.epsilon, atoms.sigma,
                    atoms.lj_cutoff > 0 ? atoms.lj_cutoff : std::numeric_limits<double>::infinity()};
  std::vector<Shell> shells;
  for (const Wall& wall : set.walls)
    shells.push_back({wall.radius, wall.atoms_per_length / (2 * units::pi * wall.radius)});
  if (shells.empty()) shells.push_back({set.radius, set.law<LineParameters>()->surface_density});
  return WallsIntegral(law, shells, shells);
}

Well pair_well(const ParameterSet& set) {
  if (!set.filament) return surface_integral(set).parallel_well();
  const LineWell well = line_parallel_well(set.law<LineParameters>()->density);
  return {well.distance, well.energy};
}

double rope_energy(const WallsIntegral& integral, int tubes, double spacing) {
  const auto places = hexagonal_lattice(tubes, spacing);
  double sum = 0;
  for (std::size_t i = 0; i < places.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      sum += integral.parallel(std::hypot(places[i].first - places[j].first, places[i].second - places[j].second));
  return sum;
}

void Bundle::place(const ParameterSet& set, int elements, const Places& places) {
  BuiltScene built = straight_tubes(set, elements, places);
  topology = std::move(built.topology);
  state = std::move(built.state);
}

Bundle line_bundle(const ParameterSet& set, int tubes, int elements) {
  Bundle b;
  b.interaction.law = line_law({line_contact_of(set)});
  b.spacing = line_parallel_well(set.law<LineParameters>()->density).distance;
  b.place(set, elements, hexagonal_lattice(tubes, b.spacing));
  b.time_step = default_step_fraction * time_step_limit(b.topology, b.interaction, b.spacing).limit;
  return b;
}

void bring_to_rest(Bundle& b) {
  b.state = at_rest(Simulation(b.topology, b.interaction, {}, b.state, b.time_step), 1e-5, 200000).state();
  b.state.velocity = b.state.angular_velocity = Vec3Array(b.state.size());
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

}  // namespace ropewalk::validate
