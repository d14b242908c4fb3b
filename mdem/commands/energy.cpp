// `energy`: one evaluation of a state, for checks by hand and by other programs.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "commands/commands.hpp"
#include "io/parameters_toml.hpp"
#include "model/error.hpp"
#include "scene/kinds/state.hpp"
#include "scene/laws/contact_law_kind.hpp"
#include "scene/prepare.hpp"
#include "scene/scene_toml.hpp"

namespace ropewalk {
namespace {

using Json = nlohmann::ordered_json;

Json vector_json(const Vector3& v) { return {v.x(), v.y(), v.z()}; }

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
  for (const ParameterSet& set : sets) {
    if (set.anharmonic) continue;
    if (name == "anharmonic")
      throw InputError({set.path, 0, "bond.anharmonic"}, "is missing, which --bond anharmonic needs",
                       "use --bond harmonic");
    return false;
  }
  return name != "harmonic";
}

void check_types(const EnergyArguments& a) {
  const int sets = static_cast<int>(a.parameters.size());
  if (sets > 1 && a.tube_types.empty())
    throw InputError({"", 0, "--tube-types"}, fmt::format("is missing, and there are {} sets", sets),
                     "say for each tube which of them it is, as in 0,1,1");
  for (const int type : a.tube_types)
    if (type < 0 || type >= sets)
      throw InputError({"", 0, "--tube-types"}, fmt::format("names type {} of {}", type, sets),
                       fmt::format("types run from 0 to {}", sets - 1));
}

Forces evaluate(const EnergyArguments& a, const BuiltScene& built, const Interaction& in) {
  Forces forces(built.state.size());
  if (a.reference) {
    compute_reference(built.topology, in, built.state, forces);
    return forces;
  }
  NeighbourList list(in, 0);
  list.build(built.topology, built.state);
  ForceEngine engine;
  engine.compute(built.topology, in, list, built.state, forces);
  return forces;
}

Json as_json(const Forces& f, const NetForce& net) {
  const Energies& e = f.energy;
  Json out;
  out["energy_eV"] = {{"stretch", e.stretch}, {"shear", e.shear}, {"bend", e.bend},
                      {"twist", e.twist},     {"vdw", e.vdw},     {"total", e.potential()}};
  Json force = Json::array(), torque = Json::array();
  for (std::size_t i = 0; i < f.force.size(); ++i) {
    force.push_back(vector_json(f.force[i]));
    torque.push_back(vector_json(f.torque[i]));
  }
  out["force_eV_per_nm"] = std::move(force);
  out["torque_eV"] = std::move(torque);
  out["net_force_eV_per_nm"] = vector_json(net.force);
  out["net_torque_eV"] = vector_json(net.torque);
  return out;
}

void print_table(const Forces& f, const NetForce& net) {
  const Energies& e = f.energy;
  fmt::print(
      "stretch {:16.9g} eV\nshear   {:16.9g} eV\nbend    {:16.9g} eV\ntwist   {:16.9g} eV\n"
      "vdW     {:16.9g} eV\ntotal   {:16.9g} eV\n\n",
      e.stretch, e.shear, e.bend, e.twist, e.vdw, e.potential());
  fmt::print("{:>8} {:>14} {:>14} {:>14}  {:>14} {:>14} {:>14}\n", "element", "Fx eV/nm", "Fy", "Fz", "Mx eV", "My",
             "Mz");
  for (std::size_t i = 0; i < f.force.size(); ++i) {
    const Vector3 a = f.force[i], b = f.torque[i];
    fmt::print("{:8} {:14.6e} {:14.6e} {:14.6e}  {:14.6e} {:14.6e} {:14.6e}\n", i, a.x(), a.y(), a.z(), b.x(),
               b.y(), b.z());
  }
  fmt::print("\nnet force  {:.3e} {:.3e} {:.3e} eV/nm\nnet torque {:.3e} {:.3e} {:.3e} eV about the origin\n",
             net.force.x(), net.force.y(), net.force.z(), net.torque.x(), net.torque.y(), net.torque.z());
}

}  // namespace

int energy_command(const EnergyArguments& a) {
  use_threads(a.threads);
  Scene scene;
  scene.path = a.state;
  for (const std::string& name : a.parameters) scene.sets.push_back(read_parameters(find_parameters(name, "")));
  scene.tube_types = a.tube_types;
  check_types(a);
  scene.bond.anharmonic = anharmonic_bond(a.bond, scene.sets);
  scene.element_length = scene.parameters().element_length;
  scene.source = std::make_shared<StateSource>(a.state);
  scene.contact.law = law_named(a.law, scene.sets);
  scene.contact.legacy_torque = a.legacy_torque;
  scene.contact.exclude_along_tube = a.exclude_along_tube;
  scene.contact.precision = Interaction::Precision::full;  // once, and compared with the reference
  const BuiltScene built = build(scene);
  const Forces forces = evaluate(a, built, interaction_of(scene));
  const NetForce net = net_force(built.state, forces);
  if (a.json) {
    fmt::print("{}\n", as_json(forces, net).dump(1));
  } else {
    print_table(forces, net);
  }
  return 0;
}

}  // namespace ropewalk
