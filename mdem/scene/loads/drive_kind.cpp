#include "scene/loads/drive_kind.hpp"

#include <algorithm>
#include <cassert>

namespace ropewalk {

// One line for each shipped drive, and one below.
DriveKind thermostat_drive();
DriveKind twist_drive();
DriveKind grip_drive();
DriveKind load_drive();
DriveKind periodic_drive();
DriveKind tether_drive();
DriveKind friction_drive();

namespace {

DriveKind with_its_energy(DriveKind kind) {
  if (kind.energy) add_term_kind({kind.table().name, kind.energy, kind.account});
  return kind;
}

std::vector<DriveKind> with_their_energies(std::vector<DriveKind> kinds) {
  for (const DriveKind& kind : kinds) with_its_energy(kind);
  return kinds;
}

std::vector<DriveKind>& kinds_of_drives() {
  static std::vector<DriveKind> kinds = with_their_energies({
      thermostat_drive(),
      twist_drive(),
      grip_drive(),
      load_drive(),
      periodic_drive(),
      tether_drive(),
      friction_drive(),
  });
  return kinds;
}

// The columns of the log must be there before main() begins.
const bool registered = !kinds_of_drives().empty();

}  // namespace

bool Drive::holds_elements() const {
  if (ends() == Ends::clamped || ends() == Ends::loaded) return true;
  const SceneTable keys = table();
  return std::any_of(keys.keys.begin(), keys.keys.end(), [](const SceneKey& key) { return key.numbers_elements; });
}

const std::vector<DriveKind>& drive_kinds() { return kinds_of_drives(); }

bool add_drive_kind(DriveKind kind) {
  assert(std::none_of(kinds_of_drives().begin(), kinds_of_drives().end(),
                      [&](const DriveKind& other) { return other.table().name == kind.table().name; }));
  kinds_of_drives().push_back(with_its_energy(kind));
  return true;
}

}  // namespace ropewalk
