#include "sim/contact/contact_law.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "sim/state/interaction.hpp"

namespace ropewalk {
namespace {

constexpr int grid = 400;

// The energy of an element of tube i against the whole tube j over its length, in eV/nm: the mean of four offsets.
double parallel_energy(const ContactLaw& law, TypePair types, double length, double distance) {
  const int reach = static_cast<int>(law.cutoff() / length) + 1;
  double sum = 0;
  for (double shift : {0.0, 0.25, 0.5, 0.75})
    for (int k = -reach; k <= reach; ++k)
      sum += law.energy(types, {distance, 0, (k + shift) * length}, Vector3::UnitZ(), Vector3::UnitZ());
  return sum / (4 * length);
}

// The energy of two tubes at a right angle, each at a quarter of an element, in eV.
double crossed_energy(const ContactLaw& law, TypePair types, double length, double distance) {
  const int reach = static_cast<int>(law.cutoff() / length) + 1;
  double sum = 0;
  for (int k = -reach; k <= reach; ++k)
    for (int l = -reach; l <= reach; ++l)
      sum += law.energy(types, {distance, (l + 0.25) * length, -(k + 0.25) * length}, Vector3::UnitZ(),
                        Vector3::UnitY());
  return sum;
}

struct Lowest {
  double distance, energy;
};

// Searches a grid up to the cutoff, then between the neighbours of the best point.
template <class Energy>
Lowest lowest(double cutoff, const Energy& energy) {
  const double step = cutoff / grid;
  Lowest best{cutoff, 0};
  for (int k = 1; k < grid; ++k)
    if (const double e = energy(k * step); e < best.energy) best = {k * step, e};
  if (best.energy == 0) return best;
  double a = best.distance - step, b = best.distance + step;
  while (b - a > 1e-9) {
    const double third = (b - a) / 3;
    if (energy(a + third) < energy(b - third)) {
      b -= third;
    } else {
      a += third;
    }
  }
  return {0.5 * (a + b), energy(0.5 * (a + b))};
}

}  // namespace

double ContactLaw::parallel_distance(TypePair types, double length) const {
  return lowest(cutoff(), [&](double d) { return parallel_energy(*this, types, length, d); }).distance;
}

double ContactLaw::crossed_distance(TypePair types, double length) const {
  return lowest(cutoff(), [&](double d) { return crossed_energy(*this, types, length, d); }).distance;
}

double ContactLaw::binding(TypePair types, double length) const {
  return -lowest(cutoff(), [&](double d) { return parallel_energy(*this, types, length, d); }).energy;
}

double Interaction::cutoff() const { return std::max(law ? law->cutoff() : 0.0, term_reach); }
double Interaction::lever() const { return law ? law->lever() : 0; }
bool Interaction::whole_ranges() const { return law && law->whole_ranges(); }

}  // namespace ropewalk
