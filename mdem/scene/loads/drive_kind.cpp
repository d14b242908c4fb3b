#include "scene/loads/drive_kind.hpp"

#include <algorithm>
#include <cassert>
#include <optional>
#include <utility>

namespace ropewalk {

// One line for each shipped drive, and one below.
DriveKind thermostat_drive();
DriveKind twist_drive();
DriveKind grip_drive();
DriveKind load_drive();
DriveKind periodic_drive();
DriveKind tether_drive();
DriveKind friction_drive();
DriveKind links_drive();
DriveKind failure_drive();

namespace {

std::vector<DriveKind> shipped_drives() {
  return {
      thermostat_drive(),
      twist_drive(),
      grip_drive(),
      load_drive(),
      periodic_drive(),
      tether_drive(),
      friction_drive(),
      links_drive(),
      failure_drive(),
  };
}

std::vector<DriveKind>& kinds_of_drives() {
  static std::vector<DriveKind> kinds = shipped_drives();
  return kinds;
}

// Without `energy` a drive has no terms.
std::optional<TermKind> term_kind_of(const DriveKind& kind) {
  if (!kind.energy) return {};
  return TermKind{kind.table().name, kind.energy, kind.account};
}

}  // namespace

std::vector<TermKind> shipped_term_kinds() {
  std::vector<TermKind> kinds;
  for (const DriveKind& drive : shipped_drives())
    if (auto kind = term_kind_of(drive)) kinds.push_back(*std::move(kind));
  return kinds;
}

bool Drive::holds_elements() const {
  if (ends() == Ends::clamped || ends() == Ends::loaded) return true;
  const SceneTable keys = table();
  return std::any_of(keys.keys.begin(), keys.keys.end(), [](const SceneKey& key) { return key.numbers_elements; });
}

const std::vector<DriveKind>& drive_kinds() { return kinds_of_drives(); }

bool add_drive_kind(DriveKind kind) {
  assert(std::none_of(kinds_of_drives().begin(), kinds_of_drives().end(),
                      [&](const DriveKind& other) { return other.table().name == kind.table().name; }));
  if (auto term = term_kind_of(kind)) add_term_kind(*std::move(term));
  kinds_of_drives().push_back(std::move(kind));
  return true;
}

}  // namespace ropewalk
