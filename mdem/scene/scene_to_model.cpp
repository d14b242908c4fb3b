#include "scene/scene_to_model.hpp"

#include <algorithm>

namespace ropewalk {
namespace {

std::vector<LineDensity> line_densities(const Scene& scene) {
  std::vector<LineDensity> out;
  for (const ParameterSet& i : scene.sets)
    for (const ParameterSet& j : scene.sets) {
      out.push_back(&i == &j ? i.line->density
                             : i.line->universal.density(i.radius, i.line->surface_density, j.radius,
                                                         j.line->surface_density));
      if (scene.contact.cutoff > 0) out.back() = with_cutoff(out.back(), scene.contact.cutoff);
    }
  return out;
}

}  // namespace

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
                       scene.run.mass_scale * set.element_inertia(scene.element_length), set.bond});
  return t;
}

PaperContact paper_contact(const Scene& scene) {
  PaperContact law = *scene.parameters().paper;
  return scene.contact.cutoff > 0 ? with_cutoff(law, scene.contact.cutoff) : law;
}

std::vector<ContactRange> contact_ranges(const Scene& scene) {
  std::vector<ContactRange> out;
  if (scene.contact.law == ContactOptions::Law::paper) {
    const PaperContact law = paper_contact(scene);
    const double length = scene.parameters().element_length;
    double deepest = 0;
    for (double d = 2 * law.radius; d < law.cutoff(); d += 0.005 * law.radius)
      deepest = std::min(deepest, paper_parallel_energy(law, length, d));
    out.push_back({law.cutoff(), -deepest});
  }
  if (scene.contact.law == ContactOptions::Law::line)
    for (const LineDensity& law : line_densities(scene))
      out.push_back({law.cutoff(), -line_parallel_well(law).energy});
  return out;
}

std::vector<LineContact> line_contacts(const Scene& scene) {
  const std::size_t types = scene.sets.size();
  std::vector<LineContact> pairs;
  std::vector<int> nodes(types, 1);  // of each type: what its most demanding partner needs
  const std::vector<LineDensity> densities = line_densities(scene);
  for (std::size_t a = 0; a < types; ++a)
    for (std::size_t b = 0; b < types; ++b) {
      LineContact pair;
      pair.density = densities[a * types + b];
      const int needed =
          line_nodes(scene.element_length, line_parallel_well(pair.density).distance, pair.density.contact);
      nodes[a] = std::max(nodes[a], scene.contact.nodes > 0 ? scene.contact.nodes : needed);
      pairs.push_back(pair);
    }
  for (std::size_t a = 0; a < types; ++a)
    for (std::size_t b = 0; b < types; ++b) {
      LineContact& pair = pairs[a * types + b];
      pair = {pair.density, scene.element_length, scene.element_length, nodes[a], nodes[b]};
    }
  return pairs;
}

Interaction interaction_of(const Scene& scene) {
  Interaction in;
  if (scene.contact.law == ContactOptions::Law::paper) in.paper = paper_contact(scene);
  if (scene.contact.law == ContactOptions::Law::line) in.line = line_contacts(scene);
  const bool relax = scene.run.mode == RunOptions::Mode::relax;
  in.precision =
      scene.contact.precision.value_or(relax ? Interaction::Precision::full : Interaction::Precision::mixed);
  in.legacy_torque = scene.contact.legacy_torque;
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
