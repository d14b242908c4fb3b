#include "scene/scene_to_model.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "model/error.hpp"
#include "scene/build.hpp"

namespace ropewalk {
namespace {

std::vector<int> selected_tubes(const Scene& scene, const Selection& on, const Topology& topology) {
  std::vector<int> tubes;
  if (on.all_tubes) {
    for (int t = 0; t < topology.tubes(); ++t) tubes.push_back(t);
    return tubes;
  }
  for (int t : on.tubes) {
    if (t < 0 || t >= topology.tubes())
      throw InputError({scene.path, 0, "load.tubes"}, fmt::format("there is no tube {}", t),
                       fmt::format("tubes are numbered from 0 to {}", topology.tubes() - 1));
    tubes.push_back(t);
  }
  return tubes;
}

std::vector<int> selected_elements(const Scene& scene, const Selection& on, const Topology& topology) {
  std::vector<int> elements;
  for (int t : selected_tubes(scene, on, topology)) {
    const int length = topology.length_of(t);
    if (on.all_elements) {
      for (int e = 0; e < length; ++e) elements.push_back(topology.tube_begin[t] + e);
      continue;
    }
    for (int e : on.elements) {
      const int at = e < 0 ? length + e : e;
      if (at < 0 || at >= length)
        throw InputError({scene.path, 0, "load.elements"}, fmt::format("tube {} has no element {}", t, e),
                         fmt::format("its elements are 0 to {}, or -1 to -{} from the end", length - 1, length));
      elements.push_back(topology.tube_begin[t] + at);
    }
  }
  return elements;
}

struct AddLoad {
  const std::vector<int>& elements;
  Drive& drive;

  void operator()(const FixLoad& f) const {
    for (int e : elements) drive.fixed.push_back({e, f.x, f.y, f.z, f.rotation});
  }
  void operator()(const ForceLoad& f) const {
    for (int e : elements) drive.loads.push_back({e, f.force, Vector3::Zero()});
  }
  void operator()(const TorqueLoad& f) const {
    for (int e : elements) drive.loads.push_back({e, Vector3::Zero(), f.torque});
  }
  void operator()(const RotateLoad& f) const {
    drive.turned.push_back({elements, f.rate, f.angle, f.centre, f.axial_free, f.spin_free});
  }
};

TwistDrive twist_of(const TwistProtocol& twist, const Topology& topology) {
  TwistDrive d;
  for (int t = 0; t < topology.tubes(); ++t) {
    d.lower.push_back(topology.tube_begin[t]);
    d.upper.push_back(topology.tube_begin[t + 1] - 1);
  }
  d.moment = twist.moment;
  d.rate = twist.rate;
  d.per_tube = twist.reading == TwistProtocol::Reading::per_tube;
  d.tangential = twist.application == TwistProtocol::Application::tangential;
  d.lateral_free = twist.lateral_free;
  d.axial_free = twist.axial_free;
  d.geometric_only = twist.geometric_only;
  d.increment = twist.increment;
  return d;
}

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

Drive drive_of(const Scene& scene, const Topology& topology) {
  Drive drive;
  for (const Load& load : scene.loads) {
    const std::vector<int> elements = selected_elements(scene, load.on, topology);
    std::visit(AddLoad{elements, drive}, load.kind);
  }
  if (scene.twist) drive.twist.push_back(twist_of(*scene.twist, topology));
  return drive;
}

}  // namespace ropewalk
