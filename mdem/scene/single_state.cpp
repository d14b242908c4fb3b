#include "scene/single_state.hpp"

#include <fmt/format.h>

#include <cmath>

#include "io/data_files.hpp"
#include "io/parameters_toml.hpp"
#include "model/error.hpp"
#include "scene/laws/contact_law_kind.hpp"
#include "scene/refuse_state.hpp"
#include "scene/scene_place.hpp"
#include "scene/scene_to_model.hpp"
#include "scene/state_csv.hpp"
#include "scene/state_files.hpp"

namespace ropewalk {
namespace {

// Empty: the default of a scene.
std::string law_named(const std::string& name, const std::vector<ParameterSet>& sets) {
  const std::string law = !name.empty() ? name : default_contact_law(sets);
  if (law == "none") return law;
  const ContactLawKind* kind = contact_law_kind(law);
  if (!kind) {
    std::string names;
    for (const ContactLawKind& k : contact_law_kinds()) names += (names.empty() ? "" : ", ") + k.name;
    throw InputError({"", 0, "--law"}, fmt::format("there is no contact law '{}'", law),
                     fmt::format("choose {} or none", names));
  }
  for (const ParameterSet& set : sets)
    if (kind->in_set && !kind->in_set(set))
      throw InputError({set.path, 0, "contact." + law}, fmt::format("the set has no `{}` law", law),
                       "use --law none");
  return law;
}

bool anharmonic_bond(const std::string& name, const std::vector<ParameterSet>& sets) {
  if (!name.empty() && name != "harmonic" && name != "anharmonic")
    throw InputError({"", 0, "--bond"}, fmt::format("there is no bond '{}'", name),
                     "choose harmonic or anharmonic");
  for (const ParameterSet& set : sets) {
    if (set.anharmonic) continue;
    if (name == "anharmonic")
      throw InputError({set.path, 0, "bond.anharmonic"}, "is missing, which --bond anharmonic needs",
                       "use --bond harmonic");
    return false;
  }
  return name != "harmonic";
}

void check_length_of_law(const Scene& scene) {
  const ContactLawKind* kind = contact_law_kind(scene.contact.law);
  const double own = scene.parameters().element_length;
  if (kind && !kind->any_element_length && std::fabs(scene.element_length / own - 1) > 1e-6)
    throw InputError(place_in(scene, "--law"),
                     fmt::format("law \"{}\" holds for elements of {:.6g} nm, and these have {:.6g} nm", kind->name,
                                 own, scene.element_length),
                     "use a set with the line law, or --law none");
}

void check_types(const SingleState& s) {
  const int sets = static_cast<int>(s.parameters.size());
  if (sets == 0) throw InputError({"", 0, "parameters"}, "names no parameter set", "name one");
  if (sets > 1 && s.tube_types.empty())
    throw InputError({"", 0, "--tube-types"}, fmt::format("is missing, and there are {} sets", sets),
                     "say for each tube which of them it is, as in 0,1,1");
  for (const int type : s.tube_types)
    if (type < 0 || type >= sets)
      throw InputError({"", 0, "--tube-types"}, fmt::format("names type {} of {}", type, sets),
                       fmt::format("types run from 0 to {}", sets - 1));
}

// Tubes beyond the twist at which tubes of their whole length collapse: between held ends they collapse later.
std::string note_of_collapse(const std::vector<ParameterSet>& sets, const Topology& topology, const State& state) {
  long beyond = 0;
  for (int t = 0; t < topology.tubes(); ++t) {
    const TubeType& type = topology.type_of(t);
    const auto& known = sets[static_cast<std::size_t>(topology.tube_type[static_cast<std::size_t>(t)])].anharmonic;
    if (!type.bond.anharmonic.used || !known || !(type.bond.anharmonic.max_shear < known->max_shear)) continue;
    const double most = type.bond.anharmonic.max_shear / type.radius * type.element_length;
    for (int i = topology.tube_begin[t]; i + 1 < topology.tube_begin[t + 1]; ++i) {
      const auto k = static_cast<std::size_t>(i);
      beyond +=
          std::fabs(bond_twist_angle(frame_of(state.orientation[k]), frame_of(state.orientation[k + 1]))) > most;
    }
  }
  if (beyond == 0) return "";
  return fmt::format(
      "{} bonds are twisted beyond the collapse of a tube of its whole length. Where a scene holds elements, the "
      "tubes between them are shorter and collapse later. The energy of twist is then another one: give the free "
      "length that `ropewalk check` prints, by --free-length-nm.",
      beyond);
}

}  // namespace

Forces forces_of(const Topology& topology, const Interaction& interaction, const State& state, bool reference,
                 const InputError::Place& place) {
  refuse_overlaps(topology, interaction, state, place, false);
  Forces forces(state.size());
  if (reference) {
    compute_reference(topology, interaction, state, forces);
  } else {
    NeighbourList list(interaction, 0);
    list.build(topology, state);
    ForceEngine engine;
    engine.compute(topology, interaction, list, state, forces);
  }
  refuse_forces(forces, place);
  return forces;
}

EvaluatedState evaluate(const SingleState& s) {
  Scene scene;
  scene.source = s.source;
  scene.path = s.source->file();
  for (const std::string& name : s.parameters) scene.sets.push_back(read_parameters(find_parameters(name, "")));
  scene.tube_types = s.tube_types;
  check_types(s);
  scene.bond.anharmonic = anharmonic_bond(s.bond, scene.sets);
  const double stated =
      s.element_length > 0 || scene.path.empty() ? s.element_length : state_element_length(scene.path);
  scene.element_length = stated > 0 ? stated : scene.parameters().element_length;
  scene.contact.law = law_named(s.law, scene.sets);
  check_length_of_law(scene);
  if (s.nodes > 0 && scene.contact.law != "line")
    throw InputError({"", 0, "--nodes-per-element"}, "belongs to the line law", "leave it out");
  scene.contact.nodes = s.nodes;
  scene.contact.legacy_torque = s.legacy_torque;
  scene.contact.exclude_along_tube = s.exclude_along_tube;
  scene.contact.precision = Interaction::Precision::full;  // once, and compared with the reference
  EvaluatedState out{scene.sets, build(scene), Interaction(), Forces(), {}, ""};
  out.broken = scene.memory.broken;
  for (std::size_t type = 0; scene.bond.anharmonic && s.free_length > 0 && type < scene.sets.size(); ++type)
    out.built.topology.types[type].bond = scene.sets[type].anharmonic_bond(s.free_length);
  if (!(s.free_length > 0)) out.note = note_of_collapse(scene.sets, out.built.topology, out.built.state);
  Interaction& interaction = out.interaction = interaction_of(scene, out.built.law);
  add_end_contacts(scene, out.built.topology, interaction);
  begin_with(scene.memory, out.built.topology, interaction);
  out.forces = forces_of(out.built.topology, interaction, out.built.state, s.reference, {scene.path, 0, ""});
  return out;
}

}  // namespace ropewalk
