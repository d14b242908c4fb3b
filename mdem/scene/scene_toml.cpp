#include "scene/scene_toml.hpp"

#include <fmt/format.h>

#include <cmath>

#include "io/files.hpp"
#include "io/toml_table.hpp"
#include "scene/laws/contact_law_kind.hpp"
#include "scene/scene_to_model.hpp"
#include "scene/tables/tables.hpp"

namespace ropewalk {
namespace {

// What the contact law asks of the parameter sets and the elements.
void check_contact_law(const TomlTable& top, const Scene& scene) {
  const ContactLawKind* kind = contact_law_kind(scene.contact.law);
  if (!kind) return;
  const double set = scene.parameters().element_length;
  if (!kind->any_element_length && std::fabs(scene.element_length - set) > 1e-6)
    throw top.error(
        "element_length_nm", fmt::format("is {} nm", scene.element_length),
        fmt::format("law \"{}\" holds for the {} nm of the set alone; leave the key out", kind->name, set));
  if (kind->check) kind->check(top, scene);
}

// Grips that are said twice.
void check_grips(const TomlTable& top, const Scene& scene) {
  if (scene.twist && !scene.grips.empty())
    throw top.error(
        "twist", "stands beside [[grip]], and both say what the ends do",
        "write the moment into a grip: as = \"each\", about_z = { torque_nN_nm = 35, rate_nN_nm_per_ps = 1 }");
}

void check_run(const TomlTable& top, const Scene& scene) {
  if (scene.run.mode == RunOptions::Mode::relax) {
    if (scene.twist)
      throw top.error("twist", "a ramp needs time, and run.mode is \"relax\"",
                      "take mode = \"dynamics\", or a [[load]] of kind \"torque\"");
    const auto refuse = [&](const char* table, const Load& load) {
      if (!load.needs_time().empty())
        throw top.error(table, load.needs_time() + ", and run.mode is \"relax\"", "take mode = \"dynamics\"");
    };
    for (const SceneLoad& load : scene.loads) refuse("load", *load.load);
    for (const SceneGrip& grip : scene.grips) refuse("grip", *grip.grip);
    if (scene.periodic) refuse("periodic", *scene.periodic);
    return;
  }
  const double protocol = protocol_time(scene);
  if (scene.run.duration <= 0 && protocol <= 0)
    throw top.table("run").error(
        "duration_ps", "is missing",
        scene.twist || !scene.grips.empty()
            ? "ramp and hold of [twist] and the schedules of grips last no time; give a "
              "duration"
            : "a run without [twist] or a [[grip]] that moves needs it: duration_ps = 100");
}

// What does not go with a thermostat.
void check_thermostat(const TomlTable& top, const Scene& scene) {
  if (!scene.thermostat) return;
  const auto refuse = [&](const char* table, const char* key, const char* why) {
    throw top.table(table).error(key, fmt::format("does not go with [thermostat]: {}", why),
                                 "take one of the two away");
  };
  if (scene.run.mode == RunOptions::Mode::relax) refuse("run", "mode", "a relaxation has no temperature");
  if (scene.damping.local > 0) refuse("damping", "pfc_local", "it brakes every velocity that the bath gives");
  if (scene.twist && scene.twist->geometric_only)
    refuse("twist", "geometric_only", "the bath turns the spins that it relaxes");
}

// What does not go with a slice that has no ends.
void check_periodic(const TomlTable& top, const Scene& scene) {
  if (!scene.periodic) return;
  const auto refuse = [&](const char* table, const char* why) {
    throw top.table("periodic")
        .error("", fmt::format("does not go with {}: {}", table, why), "take one of the two away");
  };
  if (scene.twist)
    refuse("[twist]", "the slice has no ends; give twist_deg_per_nm, and read the torque in the log");
  if (!scene.grips.empty()) refuse("[[grip]]", "the slice has no ends to be clamped");
  if (scene.kind != "rope")
    refuse(("[" + scene.kind + "]").c_str(), "tubes must be parallel and alike; it needs a [rope]");
}

// A key or table that is right elsewhere.
std::string belongs_to(const std::string& key) {
  for (const SceneTable& t : scene_tables()) {
    if (!t.name.empty() && t.name == key) return fmt::format("{} is a table of its own", t.header());
    for (const SceneKey& k : t.keys)
      if (k.key == key)
        return fmt::format("it belongs to {}",
                           t.name.empty() ? "the top of the file, before the first table" : t.header());
  }
  return "";
}

// In an order in which each finds what it needs in the scene.
void read_tables(const TomlTable& top, Scene& scene) {
  read_source(top, scene);
  scene.start = start_table().read(top.table("start"), scene);
  scene.bond = bond_table().read(top.table("bond"), scene);
  scene.contact = contact_table().read(top.table("contact"), scene);
  check_contact_law(top, scene);
  scene.damping = damping_table().read(top.table("damping"), scene);
  for (const TomlTable& t : top.tables("load")) scene.loads.push_back(read_load(t, scene));
  for (const TomlTable& t : top.tables("grip")) scene.grips.push_back(read_grip(t, scene));
  if (top.has("thermostat")) scene.thermostat = thermostat_table().read(top.table("thermostat"), scene);
  if (top.has("twist")) scene.twist = twist_table().read(top.table("twist"), scene);
  if (top.has("periodic")) scene.periodic = periodic_table().read(top.table("periodic"), scene);
  scene.run = run_table().read(top.table("run"), scene);
  scene.observe = observe_table().read(top.table("observe"), scene);
  scene.limits = limits_table().read(top.table("limits"), scene);
  for (const TomlTable& t : top.tables("stop")) scene.stops.push_back(stop_table().read(t, scene));
}

}  // namespace

Scene read_scene(const std::string& path, const std::vector<std::string>& parameters) {
  return scene_of_text(read_file(path), path, parameters);
}

Scene scene_of_text(const std::string& text, const std::string& path, const std::vector<std::string>& parameters) {
  Scene file;
  file.path = path;
  file.text = text;
  file.hash = hash_hex(text);
  KeyTable<Scene> table = top_table(parameters);
  table.defaults = file;
  const TomlTable top = TomlTable::parse(text, path);
  Scene scene = table.read(top, file);
  read_tables(top, scene);
  top.finish(belongs_to);
  check_grips(top, scene);
  check_run(top, scene);
  check_thermostat(top, scene);
  check_periodic(top, scene);
  return scene;
}

}  // namespace ropewalk
