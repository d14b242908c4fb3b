#include "scene/dissipation.hpp"

#include <cmath>

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

Damping same_dissipation(Damping d, double from, double to) {
  if (d.contact.eta > 0)
    d.contact.eta *= viscosity_per_length(d.contact, from) / viscosity_per_length(d.contact, to);
  d.bond.rate *= from * from / (to * to);
  return d;
}

}  // namespace ropewalk
