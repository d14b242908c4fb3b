#include "scene/scene_toml.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "io/files.hpp"
#include "io/toml_table.hpp"
#include "scene/drive_kind.hpp"
#include "scene/kinds/scene_kind.hpp"
#include "scene/laws/contact_law_kind.hpp"
#include "scene/scene_to_model.hpp"
#include "scene/tables/tables.hpp"

namespace ropewalk {
namespace {

// Checks the demands of the contact law on the parameter sets and the elements.
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

bool uses_newton(const Scene& scene) {
  return scene.run.mode == RunOptions::Mode::relax && scene.run.solver != RunOptions::Solver::fire;
}

// What moves in a relaxation goes by load steps, by a single one where the scene names no number.
void choose_load_steps(const TomlTable& top, Scene& scene) {
  if (scene.statics.steps > 0 && !uses_newton(scene))
    throw top.error("statics",
                    scene.run.mode == RunOptions::Mode::relax
                        ? "does not go with run.solver = \"fire\", which finds no state of rest under a held moment"
                        : "belongs to run.mode = \"relax\"",
                    "take mode = \"relax\" and solver = \"newton\" or \"auto\" in [run], or take [statics] away");
  const bool moved = uses_newton(scene) && std::any_of(scene.drives.begin(), scene.drives.end(), [](const auto& d) {
                       const auto end = d->at_its_end();
                       return d->goes_by_load_steps() && !(end ? end : d)->needs_time().empty();
                     });
  if (moved && scene.statics.steps == 0) scene.statics.steps = 1;
}

void check_run(const TomlTable& top, const Scene& scene) {
  if (scene.run.mode == RunOptions::Mode::relax) {
    for (const auto& drive : scene.drives) {
      const bool by_steps = drive->goes_by_load_steps();
      if (drive->needs_time().empty() || (by_steps && scene.statics.steps > 0)) continue;
      throw top.error(
          drive->table().name, drive->needs_time() + ", and run.mode is \"relax\"",
          by_steps ? "take solver = \"newton\" or \"auto\", or mode = \"dynamics\"" : "take mode = \"dynamics\"");
    }
    return;
  }
  if (scene.run.duration > 0 || protocol_time(scene) > 0) return;
  const bool driven = scene.has_ends(Drive::Ends::loaded) || scene.has_ends(Drive::Ends::clamped);
  throw top.table("run").error(
      "duration_ps", "is missing",
      driven ? "ramp and hold of [twist] and the schedules of grips last no time; give a duration"
             : "a run without [twist] or a [[grip]] that moves needs it: duration_ps = 100");
}

// Keys of earlier versions, and what to do without them.
constexpr std::pair<const char*, const char*> former_keys[] = {
    {"paraview", "take it away: `ropewalk convert RUN rope.pvd` writes the frames of a run for ParaView"}};

// Advice on a key or table that belongs elsewhere, or that older versions had.
std::string belongs_to(const std::string& key) {
  for (const auto& [former, remedy] : former_keys)
    if (key == former) return remedy;
  for (const SceneTable& t : scene_tables()) {
    if (!t.name.empty() && t.name == key) return fmt::format("{} is a table of its own", t.header());
    for (const SceneKey& k : t.keys)
      if (k.key == key)
        return fmt::format("it belongs to {}",
                           t.name.empty() ? "the top of the file, before the first table" : t.header());
  }
  return "";
}

TomlTable with_errors(TomlTable table) {
  table.allow_standard_errors();
  return table;
}

// Reads the tables in an order in which each finds what it needs in the scene.
void read_tables(const TomlTable& top, Scene& scene) {
  read_source(top, scene);
  scene.start = start_table().read(top.table("start"), scene);
  scene.bond = bond_table().read(top.table("bond"), scene);
  scene.contact = contact_table().read(top.table("contact"), scene);
  check_contact_law(top, scene);
  scene.damping = damping_table().read(with_errors(top.table("damping")), scene);
  for (const DriveKind& kind : drive_kinds()) {
    const SceneTable table = kind.table();
    std::vector<TomlTable> tables;
    if (table.listed)
      tables = top.tables(table.name);
    else if (top.has(table.name))
      tables = {top.table(table.name)};
    if (kind.has_properties())
      for (const TomlTable& t : tables) t.allow_standard_errors();
    if (table.listed)
      read_listed_drives(kind, tables, scene);
    else if (!tables.empty())
      scene.drives.push_back(kind.read(tables.front(), scene));
  }
  scene.run = run_table().read(top.table("run"), scene);
  if (top.has("statics")) scene.statics = statics_table().read(top.table("statics"), scene);
  scene.observe = observe_table().read(top.table("observe"), scene);
  scene.limits = limits_table().read(top.table("limits"), scene);
  for (const TomlTable& t : top.tables("stop")) scene.stops.push_back(stop_table().read(t, scene));
  for (const TomlTable& t : top.tables("expect")) scene.expected.push_back(expect_table().read(t, scene));
  for (Expectation& e : scene.expected)
    e.of_other_scene = !e.scene_hash.empty() && e.scene_hash != what_is_run_hash(scene.text);
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
  choose_load_steps(top, scene);
  if (scene.run.mode == RunOptions::Mode::relax && scene.statics.steps == 0)
    for (auto& drive : scene.drives)
      if (auto held = drive->at_its_end()) drive = std::move(held);
  for (const auto& drive : scene.drives) drive->refuse(top, scene);
  check_run(top, scene);
  return scene;
}

}  // namespace ropewalk
