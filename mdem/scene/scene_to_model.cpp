#include "scene/scene_to_model.hpp"

#include "scene/laws/contact_law_kind.hpp"

namespace ropewalk {
std::vector<Validity> validities(const Scene& scene) {
  std::vector<Validity> all;
  for (const ParameterSet& set : scene.sets) all.push_back(set.validity);
  return all;
}

Topology empty_topology(const Scene& scene) {
  Topology t;
  t.types.clear();
  for (const ParameterSet& set : scene.sets)
    t.types.push_back({scene.element_length, set.radius,
                       scene.run.mass_scale * set.element_mass(scene.element_length),
                       scene.run.mass_scale * set.element_inertia(scene.element_length),
                       scene.bond.anharmonic ? set.anharmonic_bond() : set.bond});
  return t;
}

std::vector<ContactRange> contact_ranges(const Scene& scene) {
  std::vector<ContactRange> out;
  const auto law = contact_law(scene);
  for (int i = 0; law && i < static_cast<int>(scene.sets.size()); ++i)
    for (int j = 0; j < static_cast<int>(scene.sets.size()); ++j)
      out.push_back({law->range({i, j}), law->binding({i, j}, scene.element_length)});
  return out;
}

std::shared_ptr<const ContactLaw> contact_law(const Scene& scene) {
  const ContactLawKind* kind = contact_law_kind(scene.contact.law);
  return kind ? kind->make(scene) : nullptr;
}

Interaction interaction_of(const Scene& scene) {
  Interaction in;
  in.law = contact_law(scene);
  const bool relax = scene.run.mode == RunOptions::Mode::relax;
  in.precision =
      scene.contact.precision.value_or(relax ? Interaction::Precision::full : Interaction::Precision::mixed);
  in.exclude_along_tube = scene.contact.exclude_along_tube;
  in.damping = scene.damping;
  return in;
}

LoadsAndConstraints loads_of(const Scene& scene, const Topology& topology) {
  LoadsAndConstraints loads;
  for (const SceneLoad& typed : scene.loads) {
    const std::shared_ptr<Load> load = typed.load->copy();
    load->elements = selected_elements(scene, typed.on, topology);
    loads.add(std::shared_ptr<const Load>(load));
  }
  if (scene.twist) add_twist(*scene.twist, topology, loads);
  return loads;
}

}  // namespace ropewalk
