#include "scene/parts_in_use.hpp"

#include <algorithm>

#include "scene/drive_kind.hpp"
#include "scene/loads/load_kind.hpp"
#include "scene/own_parts.hpp"

namespace ropewalk {

std::vector<PartInUse> parts_in_use(const Scene& scene) {
  std::vector<PartInUse> parts;
  const auto add = [&](const char* what, const std::string& name, const std::string& key) {
    if (is_own_part(what, name)) parts.push_back({what + (" " + name), key});
  };
  add("scene kind", scene.kind, scene.kind);
  add("contact law", scene.contact.law, "contact.law");
  for (const auto& drive : scene.drives) {
    const std::string table = drive->table().name;
    add("drive", table, table);
    if (const auto* load = dynamic_cast<const LoadDrive*>(drive.get())) add("load", load->kind.name, "load.kind");
  }
  return parts;
}

std::string own_parts_of_run(const Scene& scene) {
  std::vector<std::string> all;
  const auto add = [&](const std::string& words) {
    if (std::find(all.begin(), all.end(), words) == all.end()) all.push_back(words);
  };
  for (const PartInUse& part : parts_in_use(scene)) add(part.words);
  for (const DriveKind& kind : drive_kinds())
    if (kind.has_properties() && is_own_part("drive", kind.table().name)) add("drive " + kind.table().name);
  std::string text;
  for (const std::string& words : all) text += (text.empty() ? "" : ", ") + words;
  return text;
}

}  // namespace ropewalk
