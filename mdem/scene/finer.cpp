#include "scene/finer.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <sstream>

#include "sim/dynamics/refine.hpp"

namespace ropewalk {
namespace {

toml::table& table_of(toml::table& top, const char* name) {
  if (!top.contains(name)) top.insert(name, toml::table{});
  return *top[name].as_table();
}

void set_lengths(const Scene& scene, const Topology& topology, toml::table& top) {
  top.insert_or_assign("element_length_nm", 0.5 * scene.element_length);
  const double length = topology.length_of(0) * scene.element_length;
  if (auto* rope = top["rope"].as_table()) rope->insert_or_assign("length_nm", length);
  if (auto* film = top["film"].as_table()) film->insert_or_assign("length_nm", length);
  if (auto* chain = top["chain"].as_table()) chain->insert_or_assign("elements", 2 * topology.length_of(0));
}

void set_contact(const Scene& scene, toml::table& top) {
  toml::table& contact = table_of(top, "contact");
  contact.insert_or_assign("exclude_along_tube_elements",
                           std::min(2 * scene.contact.exclude_along_tube, most_elements));
  if (scene.contact.nodes > 0) contact.insert_or_assign("nodes_per_element", (scene.contact.nodes + 1) / 2);
}

// With most_damping as the reader has it.
Damping finer_damping(Damping d) {
  constexpr double most_damping = 1e4;
  d.contact.eta *= 0.25;
  d.bond.rate = std::min(4 * d.bond.rate, most_damping);
  return d;
}

void set_damping(const Scene& scene, toml::table& top) {
  const Damping finer = finer_damping(scene.damping);
  toml::table& damping = table_of(top, "damping");
  damping.insert_or_assign("contact_viscosity_eV_ps_per_nm2", finer.contact.eta);
  damping.insert_or_assign("bond_damping_per_ps", finer.bond.rate);
}

toml::array both_halves(const Selection& on) {
  toml::array elements;
  for (const int e : on.elements) {
    elements.push_back(2 * e);  // from the end as well: -1 becomes -2 and -1
    elements.push_back(2 * e + 1);
  }
  return elements;
}

void halve_vector(toml::table& load, const char* key) {
  auto* vector = load[key].as_array();
  if (!vector) return;
  toml::array half;
  for (const auto& component : *vector) half.push_back(0.5 * component.value_or(0.0));
  load.insert_or_assign(key, half);
}

void set_loads(const Scene& scene, toml::table& top) {
  auto* loads = top["load"].as_array();
  if (!loads) return;
  for (std::size_t k = 0; k < scene.loads.size(); ++k) {
    toml::table& load = *loads->get_as<toml::table>(k);
    if (!scene.loads[k].on.all_elements) load.insert_or_assign("elements", both_halves(scene.loads[k].on));
    halve_vector(load, "force_nN");
    halve_vector(load, "torque_nN_nm");
  }
}

// The law and its reach come from the scene, so that the finer one is needed for the limit of its time step.
double finer_time_step(const Scene& scene, const Prepared& p) {
  Scene finer = scene;
  finer.element_length *= 0.5;
  finer.contact.nodes = (scene.contact.nodes + 1) / 2;
  finer.damping = finer_damping(scene.damping);
  const double limit = time_step_limit(halved(p.topology), interaction_of(finer), p.spacing).limit;
  return scene.run.time_step / p.limit.limit * limit;
}

}  // namespace

std::string why_not_finer(const Scene& scene, const Topology& topology) {
  if (scene.contact.law == ContactOptions::Law::paper)
    return fmt::format("law \"paper\" holds for elements of {:.4g} nm alone", scene.parameters().element_length);
  const double half = 0.5 * scene.element_length, radius = topology.largest_radius();
  if (half < 0.99 * radius)
    return fmt::format("elements of {:.4g} nm would be shorter than the radius of the tube, {:.4g} nm", half,
                       radius);
  if (2.0 * topology.elements() > most_elements)
    return fmt::format("twice {} elements are more than the {} allowed", topology.elements(), most_elements);
  return "";
}

std::string finer_scene_text(const Scene& scene, const Prepared& prepared, const std::string& comment) {
  toml::table top = toml::parse(scene.text);
  top.insert_or_assign("name", scene.name);
  set_lengths(scene, prepared.topology, top);
  set_contact(scene, top);
  set_damping(scene, top);
  set_loads(scene, top);
  if (scene.run.time_step > 0)
    table_of(top, "run").insert_or_assign("time_step_fs", finer_time_step(scene, prepared) / units::fs);
  std::ostringstream text;
  text << "# " << comment << "\n" << top << "\n";
  return text.str();
}

}  // namespace ropewalk
