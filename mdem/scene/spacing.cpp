#include "scene/spacing.hpp"

#include <algorithm>

#include "scene/scene_to_model.hpp"
#include "sim/contact/contact_law.hpp"

namespace ropewalk {
namespace {

using Distance = double (ContactLaw::*)(TypePair, double) const;

double distance_of(const Scene& scene, const ContactLaw* law, TypePair types, Distance distance) {
  if (law) return (law->*distance)(types, scene.element_length);
  const auto radius = [&](int type) { return scene.sets[static_cast<std::size_t>(type)].radius; };
  return radius(types.i) + radius(types.j) + graphite_gap;
}

// Largest distance over all pairs of tube types.
double largest_distance(const Scene& scene, const ContactLaw* law, Distance distance) {
  double largest = 0;
  const int types = static_cast<int>(scene.sets.size());
  for (int i = 0; i < types; ++i)
    for (int j = 0; j < types; ++j) largest = std::max(largest, distance_of(scene, law, {i, j}, distance));
  return largest;
}

// The force (eV/nm) that drives two long tubes of elements of this length in line apart.
double force_of_ends(const ContactLaw& law, TypePair types, double element_length, double gap) {
  const int reach = static_cast<int>(law.cutoff() / element_length) + 2;
  double force = 0;
  for (int i = 0; i < reach; ++i)
    for (int j = 0; j < reach; ++j) {
      const Vector3 apart(0, 0, gap + (i + j + 1) * element_length);
      if (apart.z() < law.cutoff())
        force += law.force(types, apart, Vector3::UnitZ(), Vector3::UnitZ()).force_j.z();
    }
  return force;
}

}  // namespace

double largest_radius(const Scene& scene) {
  double largest = 0;
  for (const ParameterSet& set : scene.sets) largest = std::max(largest, set.radius);
  return largest;
}

double own_element_length(const Scene& scene) {
  double sum = 0;
  for (const ParameterSet& set : scene.sets) sum += set.element_length;
  return sum / static_cast<double>(scene.sets.size());
}

double parallel_spacing(const Scene& scene, const ContactLaw* law) {
  return largest_distance(scene, law, &ContactLaw::parallel_distance);
}

double pair_spacing(const Scene& scene, const ContactLaw* law, TypePair types) {
  return distance_of(scene, law, types, &ContactLaw::parallel_distance);
}

double coaxial_gap(const Scene& scene) {
  if (const std::vector<EndContact> ends = end_contacts(scene); !ends.empty()) {
    const auto rests_nearer = [](const EndContact& a, const EndContact& b) { return a.rest() < b.rest(); };
    return std::max_element(ends.begin(), ends.end(), rests_nearer)->rest();
  }
  const std::shared_ptr<const ContactLaw> law = contact_law(scene);
  double largest = graphite_gap;
  const auto types = static_cast<int>(scene.sets.size());
  for (int i = 0; law && i < types; ++i)
    for (int j = 0; j < types; ++j) {
      // Searches from afar, where tubes attract, to the first push.
      double far = law->range({i, j}), near = far;
      const auto push = [&](double gap) { return force_of_ends(*law, {i, j}, scene.element_length, gap); };
      while (near > graphite_gap && !(push(near) > 0)) far = near, near -= 0.02;
      if (near <= graphite_gap) continue;
      for (int k = 0; k < 40; ++k) {
        const double middle = 0.5 * (near + far);
        (push(middle) > 0 ? near : far) = middle;
      }
      largest = std::max(largest, far);
    }
  return largest;
}

double crossed_spacing(const Scene& scene) {
  return largest_distance(scene, contact_law(scene).get(), &ContactLaw::crossed_distance);
}

}  // namespace ropewalk
