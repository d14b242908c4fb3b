#include "scene/spacing.hpp"

#include <algorithm>

#include "scene/scene_to_model.hpp"

namespace ropewalk {
namespace {

// The largest of all pairs of tube types, by this function of the law.
double largest_distance(const Scene& scene, const ContactLaw* law,
                        double (ContactLaw::*distance)(TypePair, double) const) {
  if (!law) return 2 * largest_radius(scene) + graphite_gap;
  double largest = 0;
  for (int i = 0; i < static_cast<int>(scene.sets.size()); ++i)
    for (int j = 0; j < static_cast<int>(scene.sets.size()); ++j)
      largest = std::max(largest, ((*law).*distance)({i, j}, scene.element_length));
  return largest;
}

}  // namespace

double largest_radius(const Scene& scene) {
  double largest = 0;
  for (const ParameterSet& set : scene.sets) largest = std::max(largest, set.radius);
  return largest;
}

double parallel_spacing(const Scene& scene, const ContactLaw* law) {
  return largest_distance(scene, law, &ContactLaw::parallel_distance);
}

double crossed_spacing(const Scene& scene) {
  return largest_distance(scene, contact_law(scene).get(), &ContactLaw::crossed_distance);
}

}  // namespace ropewalk
