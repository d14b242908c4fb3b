#include "scene/finer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <sstream>

#include "io/plain_text.hpp"
#include "io/toml_text.hpp"
#include "scene/bounds.hpp"
#include "scene/drive_kind.hpp"
#include "scene/laws/contact_law_kind.hpp"
#include "scene/scene_to_model.hpp"
#include "scene/scene_toml.hpp"
#include "sim/dynamics/refine.hpp"

namespace ropewalk {
namespace {

toml::table& table_of(toml::table& top, const std::string& name) {
  if (!top.contains(name)) top.insert(name, toml::table{});
  return *top[name].as_table();
}

// The numbers of the elements that take the places of the listed ones. Counted from the end, -1 stays and -2
// becomes -3.
toml::array in_the_same_places(const toml::array& typed) {
  toml::array elements;
  for (const auto& e : typed) {
    const std::int64_t at = e.value_or(std::int64_t{0});
    elements.push_back(at < 0 ? 2 * at + 1 : 2 * at);
  }
  return elements;
}

// Whether the table lists the elements on which it acts. Their number then stays, and so does the load on each.
bool numbers_elements(const SceneTable& keys, const toml::table& table) {
  return std::any_of(keys.keys.begin(), keys.keys.end(), [&](const SceneKey& key) {
    return key.numbers_elements && table[key.key].value_or(std::string()) != "all";
  });
}

// Rewrites a key for elements of half the length, `elements` of them in a tube. Keys that do not depend on the
// elements, and keys that the program chooses, stay unwritten. `numbered`: the table acts on elements that it
// numbers.
void refine_key(const SceneKey& key, const Scene& scene, int elements, bool numbered, toml::table& table) {
  if (key.tube_size == SceneKey::TubeSize::length)
    table.insert_or_assign(key.key, elements * 0.5 * scene.element_length);
  if (key.tube_size == SceneKey::TubeSize::elements) table.insert_or_assign(key.key, elements);
  if (const auto* list = table[key.key].as_array(); list && key.numbers_elements) {
    const toml::array there = in_the_same_places(*list);
    table.insert_or_assign(key.key, there);
  }
  if (key.counts_held && table.contains(key.key))
    table.insert_or_assign(key.key, 2 * table[key.key].value_or(std::int64_t{1}) - 1);
  if (key.length_power == 0 || numbered) return;
  const double factor = std::pow(0.5, key.length_power);
  if (const auto* vector = table[key.key].as_array()) {
    toml::array refined;
    for (const auto& component : *vector) refined.push_back(factor * component.value_or(0.0));
    table.insert_or_assign(key.key, refined);
    return;
  }
  const bool typed = table.contains(key.key);
  if (!typed && !key.standard.empty()) return;
  const double value = typed ? table[key.key].value_or(0.0) : leading_number(key.value).value_or(0);
  const double refined = std::min(factor * value, key.most);
  if (key.whole)
    table.insert_or_assign(key.key, static_cast<std::int64_t>(std::ceil(refined)));
  else
    table.insert_or_assign(key.key, refined);
}

// Refined with each drive.
bool is_drive(const std::string& table) {
  return std::any_of(drive_kinds().begin(), drive_kinds().end(),
                     [&](const DriveKind& kind) { return kind.table().name == table; });
}

void refine_tables(const Scene& scene, int elements, toml::table& top) {
  for (const SceneTable& table : scene_tables()) {
    const bool matters = std::any_of(table.keys.begin(), table.keys.end(), [](const SceneKey& k) {
      return k.length_power != 0 || k.tube_size != SceneKey::TubeSize::no;
    });
    if (table.name.empty() || table.listed || is_drive(table.name) || !matters) continue;
    if (!top.contains(table.name) && table.optional()) continue;
    for (const SceneKey& key : table.keys) refine_key(key, scene, elements, false, table_of(top, table.name));
  }
}

void refine_drives(const Scene& scene, int elements, toml::table& top) {
  std::map<std::string, std::size_t> found;
  for (const auto& drive : scene.drives) {
    const SceneTable table = drive->table();
    toml::node& typed = *top.get(table.name);
    toml::table& keys =
        table.listed ? *typed.as_array()->get_as<toml::table>(found[table.name]++) : *typed.as_table();
    const bool numbered = numbers_elements(table, keys);
    for (const SceneKey& key : table.keys) refine_key(key, scene, elements, numbered, keys);
  }
}

// The typed step's share of the stability limit stays.
double finer_time_step(const Scene& scene, const Prepared& p, const std::string& text) {
  std::vector<std::string> sets;
  for (const ParameterSet& set : scene.sets) sets.push_back(set.path);
  Scene finer = scene_of_text(text, scene.path, sets);
  finer.damping.contact.inner = scene.damping.contact.inner;
  finer.damping.contact.outer = scene.damping.contact.outer;
  const Topology halves = halved(p.topology, splitting_of(scene));
  Interaction interaction = interaction_of(finer);
  add_terms(finer, halves, halved(p.topology, p.state, splitting_of(scene)), interaction);
  const double limit = time_step_limit(halves, interaction, p.spacing).limit;
  return scene.run.time_step / p.limit.limit * limit;
}

std::string finer_text(const toml::table& top, const std::string& comment) {
  std::ostringstream text;
  text << "# " << comment << "\n" << top << "\n";
  return text.str();
}

}  // namespace

Splitting splitting_of(const Scene& scene) { return holds_elements(scene) ? Splitting::between : Splitting::whole; }

std::string why_not_finer(const Scene& scene, const Topology& topology) {
  for (const auto& drive : scene.drives)
    if (const std::string why = drive->why_not_split(); !why.empty()) return why;
  if (!scene.memory.broken.empty()) return "tubes of the state have broken";
  if (!topology.groups.strand_begin.empty())
    return "tubes end inside of the rope, at places that follow from its elements";
  const ContactLawKind* law = contact_law_kind(scene.contact.law);
  if (law && !law->any_element_length)
    return fmt::format("law \"{}\" holds for elements of {:.4g} nm alone", law->name,
                       scene.parameters().element_length);
  const double half = 0.5 * scene.element_length, radius = topology.largest_radius();
  if (half < 0.99 * radius)
    return fmt::format("elements of {:.4g} nm would be shorter than the radius of the tube, {:.4g} nm", half,
                       radius);
  for (int t = 0; splitting_of(scene) == Splitting::between && t < topology.tubes(); ++t)
    if (topology.length_of(t) == 1)
      return fmt::format("tube {} has one element, and a drive holds single elements where they are", t);
  if (2.0 * topology.elements() > max_elements)
    return fmt::format("twice {} elements are more than the {} allowed", topology.elements(), max_elements);
  return "";
}

std::string finer_scene_text(const Scene& scene, const Prepared& prepared, const std::string& comment) {
  toml::table top = parsed_toml(scene.text, scene.path);
  top.insert_or_assign("name", scene.name);
  top.insert_or_assign("element_length_nm", 0.5 * scene.element_length);
  const int elements = halved(prepared.topology, splitting_of(scene)).length_of(0);
  refine_tables(scene, elements, top);
  refine_drives(scene, elements, top);
  if (scene.run.time_step > 0)
    table_of(top, "run")
        .insert_or_assign("time_step_fs", finer_time_step(scene, prepared, finer_text(top, comment)) / units::fs);
  return finer_text(top, comment);
}

}  // namespace ropewalk
