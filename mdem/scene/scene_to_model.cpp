#include "scene/scene_to_model.hpp"

#include <algorithm>
#include <utility>

#include "model/self_contact.hpp"
#include "scene/laws/contact_law_kind.hpp"
#include "sim/forces/terms/tube_ends.hpp"

namespace ropewalk {

Topology empty_topology(const Scene& scene) {
  Topology t;
  t.types.clear();
  for (const ParameterSet& set : scene.sets)
    t.types.push_back({scene.element_length, set.radius,
                       scene.run.mass_scale * set.element_mass(scene.element_length),
                       scene.run.mass_scale * set.element_inertia(scene.element_length),
                       scene.bond.anharmonic ? set.anharmonic_bond(0) : set.bond});
  return t;
}

bool holds_elements(const Scene& scene) {
  return std::any_of(scene.drives.begin(), scene.drives.end(), [](const auto& d) { return d->holds_elements(); });
}

int elements_held(const Scene& scene, int tube) {
  if (!holds_elements(scene)) return 0;
  int sum = -1;
  for (const End end : {lower_end, upper_end}) {
    int most = 1;
    for (const auto& drive : scene.drives) most = std::max(most, drive->held(end, tube));
    sum += most;
  }
  return sum;
}

double free_length(const Scene& scene, const Topology& topology, int tube) {
  const double holes = topology.groups.strand_begin.empty() ? topology.groups.strand_holes : 0;
  return std::max(1, topology.length_of(tube) - elements_held(scene, tube)) *
             topology.type_of(tube).element_length +
         holes;
}

namespace {

// Length of the longest tube of a type, which collapses first, nm; 0: endless.
double collapsing_length(const Scene& scene, const Topology& topology, std::size_t type) {
  double most = 0;
  for (int t = 0; !scene.has_ends(Drive::Ends::endless) && t < topology.tubes(); ++t)
    if (topology.tube_type[static_cast<std::size_t>(t)] == static_cast<int>(type))
      most = std::max(most, free_length(scene, topology, t));
  return most;
}

}  // namespace

void set_collapse(const Scene& scene, Topology& topology) {
  for (std::size_t type = 0; scene.bond.anharmonic && type < topology.types.size(); ++type)
    topology.types[type].bond = scene.sets[type].anharmonic_bond(collapsing_length(scene, topology, type));
}

std::vector<Validity> validities(const Scene& scene, const Topology& topology) {
  std::vector<Validity> all;
  for (std::size_t type = 0; type < scene.sets.size(); ++type) {
    const ParameterSet& set = scene.sets[type];
    all.push_back(set.validity);
    if (scene.bond.anharmonic && set.pull) all.back().tension = set.end_of_stretch();
    all.back().twist_collapse = set.validity.collapse_at(set.radius, collapsing_length(scene, topology, type));
  }
  return all;
}

std::vector<ContactRange> contact_ranges(const Scene& scene, const ContactLaw* law) {
  std::vector<ContactRange> out;
  for (int i = 0; law && i < static_cast<int>(scene.sets.size()); ++i)
    for (int j = 0; j < static_cast<int>(scene.sets.size()); ++j)
      out.push_back({law->range({i, j}), law->binding({i, j}, scene.element_length)});
  return out;
}

double least_exclusion(const Scene& scene, const ContactLaw* law) {
  double length = 0;
  for (int t = 0; law && t < static_cast<int>(scene.sets.size()); ++t)
    length = std::max(
        length, nearest_arc(scene.sets[static_cast<std::size_t>(t)].validity.kink_curvature, law->range({t, t})));
  return length;
}

std::shared_ptr<const ContactLaw> contact_law(const Scene& scene) {
  const ContactLawKind* kind = contact_law_kind(scene.contact.law);
  return kind ? kind->make(scene) : nullptr;
}

std::vector<EndContact> end_contacts(const Scene& scene) {
  const ContactLawKind* kind = contact_law_kind(scene.contact.law);
  return kind && kind->ends ? kind->ends(scene) : std::vector<EndContact>();
}

bool ends_meet(const Scene& scene, const Topology& topology) {
  return topology.strands() < topology.tubes() && !end_contacts(scene).empty();
}

void add_end_contacts(const Scene& scene, const Topology& topology, Interaction& interaction) {
  if (topology.groups.ends_meet) add_term(tube_ends_term(end_contacts(scene), topology), interaction);
}

Interaction interaction_of(const Scene& scene, std::shared_ptr<const ContactLaw> law) {
  Interaction in;
  in.law = std::move(law);
  const bool relax = scene.run.mode == RunOptions::Mode::relax;
  in.precision =
      scene.contact.precision.value_or(relax ? Interaction::Precision::full : Interaction::Precision::mixed);
  in.exclude_along_tube = scene.contact.exclude_along_tube > 0 ? scene.contact.exclude_along_tube
                                                               : least_exclusion(scene, in.law.get());
  in.damping = scene.damping;
  return in;
}

void add_terms(const Scene& scene, const Topology& topology, const State& start, Interaction& interaction) {
  for (const auto& drive : scene.drives) drive->add_terms(scene, topology, start, interaction);
  add_end_contacts(scene, topology, interaction);
}

double protocol_time(const Scene& scene) {
  double last = 0;
  for (const auto& drive : scene.drives) last = std::max(last, drive->lasts());
  return last;
}

LoadsAndConstraints loads_of(const Scene& scene, const Topology& topology, const Interaction& interaction) {
  LoadsAndConstraints loads;
  for (const auto& drive : scene.drives) drive->add_loads(scene, topology, interaction, loads);
  return loads;
}

}  // namespace ropewalk
