#include "scene/dissipation.hpp"

#include <cmath>

#include "scene/spacing.hpp"

namespace ropewalk {
namespace {

// The viscosity of one tube against a neighbour, per length.
double viscosity_per_length(const ContactViscosity& viscosity, double element_length) {
  const int reach = static_cast<int>(viscosity.outer / element_length) + 1;
  double sum = 0;
  for (int k = -reach; k <= reach; ++k) sum += viscosity.weight(std::hypot(viscosity.inner, k * element_length));
  return viscosity.eta * sum / element_length;
}

}  // namespace

double contact_viscosity(double per_length, double a, double radius) {
  constexpr double eta = 20, published_length = 1.356, published_radius = 0.678;  // eV ps/nm^2, nm
  const double longer = a / published_length;
  const double by_default =
      eta * longer * longer * (2 * published_radius + graphite_gap) / (2 * radius + graphite_gap);
  return per_length == default_viscosity ? by_default : per_length * by_default / default_viscosity;
}

double contact_viscosity(double per_length, double a, const std::vector<ParameterSet>& sets) {
  double sum = 0;
  for (const ParameterSet& set : sets) sum += contact_viscosity(per_length, a, set.radius);
  return sum / static_cast<double>(sets.size());
}

Damping same_dissipation(Damping d, double from, double to) {
  if (d.contact.eta > 0)
    d.contact.eta *= viscosity_per_length(d.contact, from) / viscosity_per_length(d.contact, to);
  d.bond.rate *= from * from / (to * to);
  return d;
}

}  // namespace ropewalk
