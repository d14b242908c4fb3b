#include "observe/rope_size.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "model/units.hpp"

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

std::string size_words(const RopeSize& size) {
  constexpr double tex = 1e-6;                                                           // kg/m
  const double per_m = size.mass_per_length * units::mass_unit_kg * 1e9;                 // kg/m
  const double density = size.mass_per_length / size.area * units::mass_unit_kg * 1e27;  // kg/m^3
  if (!std::isfinite(density)) return "";
  return fmt::format("linear density {:.4g} tex, cross-section {:.4g} nm^2, {:.4g} g/cm^3: 1 GPa is {:.3g} N/tex",
                     per_m / tex, size.area, 1e-3 * density, 1e3 / density);
}

}  // namespace ropewalk
