#include "scene/input_numbers.hpp"

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "io/files.hpp"
#include "io/toml_table.hpp"
#include "scene/drive_kind.hpp"
#include "scene/scene_keys.hpp"

namespace ropewalk {
namespace {

// Keys that the reader still takes in the place of one of these.
constexpr std::pair<const char*, const char*> former_keys[] = {
    {"contact_viscosity_eV_ps_per_nm3", "contact_viscosity_eV_ps_per_nm2"}};

std::string typed_key(const TomlTable& t, const std::string& key) {
  for (const auto& [now, before] : former_keys)
    if (key == now && t.has(before)) return before;
  return key;
}

// Every { value = , standard_error = } of a file.
void walk(const TomlTable& t, std::size_t file, const Drive& drive, std::vector<InputNumber>& all) {
  for (const std::string& key : t.keys()) {
    if (!t.is_table(key)) continue;
    const TomlTable inside = t.table(key);
    if (!inside.has("value") || !inside.has("standard_error")) {
      walk(inside, file, drive, all);
    } else if (drive.depends_on(inside.path())) {
      InputNumber number{
          InputNumber::Of::file, file, inside.path(), inside.number("value", Bounds::any()), {}, true};
      if (!inside.is_string("standard_error"))
        number.standard_error = inside.number("standard_error", Bounds::non_negative());
      all.push_back(std::move(number));
    }
  }
}

// `path` of the table in the scene: "links.1" of a listed one. `always`: it acts with its defaults where it is
// missing.
void add_typed(const TomlTable& t, const SceneTable& table, const std::string& path, bool always,
               std::vector<InputNumber>& all) {
  t.allow_standard_errors();
  for (const SceneKey& key : table.keys) {
    if (!key.number) continue;
    const std::string typed = typed_key(t, key.key);
    InputNumber number{InputNumber::Of::scene, 0, path + "." + typed, 0, {}, t.has(typed)};
    if (number.typed) {
      number.value = t.number(typed, Bounds::any());
      number.standard_error = t.standard_error(typed);
    } else if (always) {
      number.value = std::strtod(key.value.c_str(), nullptr);
    } else {
      continue;
    }
    all.push_back(std::move(number));
  }
}

void add_typed(const TomlTable& top, const SceneTable& table, std::vector<InputNumber>& all) {
  const bool drive = std::any_of(drive_kinds().begin(), drive_kinds().end(),
                                 [&](const DriveKind& kind) { return kind.table().name == table.name; });
  if (table.listed) {
    const std::vector<TomlTable> tables = top.tables(table.name);
    for (std::size_t k = 0; k < tables.size(); ++k)
      add_typed(tables[k], table, table.name + "." + std::to_string(k), false, all);
  } else if (!drive || top.has(table.name)) {
    add_typed(top.table(table.name), table, table.name, !drive, all);
  }
}

}  // namespace

std::vector<std::string> input_files(const Scene& scene) {
  std::vector<std::string> files;
  for (const std::string& file : scene.files_of_drives())
    if (std::find(files.begin(), files.end(), file) == files.end()) files.push_back(file);
  return files;
}

std::vector<InputNumber> input_numbers(const Scene& scene) {
  std::vector<InputNumber> all;
  for (std::size_t k = 0; k < scene.sets.size(); ++k)
    for (const Quantity& q : scene.sets[k].quantities)
      all.push_back({InputNumber::Of::set, k, q.key, q.value, q.standard_error, true});
  const std::vector<std::string> files = input_files(scene);
  for (std::size_t k = 0; k < files.size(); ++k)
    for (const auto& drive : scene.drives) {
      const std::vector<std::string> own = drive->files();
      if (std::find(own.begin(), own.end(), files[k]) == own.end()) continue;
      walk(TomlTable::parse(read_file(files[k]), files[k]), k, *drive, all);
      break;
    }
  const TomlTable top = TomlTable::parse(scene.text, scene.path);
  for (const SceneTable& table : scene_tables())
    if (table.has_properties) add_typed(top, table, all);
  return all;
}

}  // namespace ropewalk
