#include "observe/rope_size.hpp"

#include <cmath>
#include <limits>

namespace ropewalk {

std::vector<double> packing_cells(const Topology& topology, double spacing, const ContactLaw* law) {
  const int types = static_cast<int>(topology.types.size());
  std::vector<double> out;
  for (int k = 0; k < types; ++k) {
    const double apart =
        types > 1 && spacing > 0 && law
            ? law->parallel_distance({k, k}, topology.types[static_cast<std::size_t>(k)].element_length)
            : spacing;
    out.push_back(0.5 * std::sqrt(3.0) * apart * apart);
  }
  return out;
}

RopeSize rope_size(const Topology& topology, const std::vector<double>& cells, double mass_scale) {
  RopeSize out;
  for (int t = 0; t < topology.tubes();) {
    const int last = topology.strand_of(t).second;
    double mass = 0, length = 0, volume = 0;
    for (; t <= last; ++t) {
      const TubeType& type = topology.type_of(t);
      const int own = topology.own_elements(t);
      mass += own * type.mass / mass_scale;
      length += own * type.element_length;
      volume += own * type.element_length * cells[static_cast<std::size_t>(topology.tube_type[t])];
    }
    out.mass += mass;
    out.mass_per_length += mass / length;
    out.area += volume / length;
  }
  if (!(out.area > 0)) out.area = std::numeric_limits<double>::quiet_NaN();
  if (!(out.mass > 0)) out.mass_per_length = std::numeric_limits<double>::quiet_NaN();
  return out;
}

}  // namespace ropewalk
