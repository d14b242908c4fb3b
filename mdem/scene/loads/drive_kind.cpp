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

namespace {

std::vector<DriveKind>& kinds_of_drives() {
  static std::vector<DriveKind> kinds = {
      thermostat_drive(),
      twist_drive(),
      grip_drive(),
      load_drive(),
      periodic_drive(),
  };
  return kinds;
}

}  // namespace

const std::vector<DriveKind>& drive_kinds() { return kinds_of_drives(); }

bool add_drive_kind(DriveKind kind) {
  assert(std::none_of(kinds_of_drives().begin(), kinds_of_drives().end(),
                      [&](const DriveKind& other) { return other.table().name == kind.table().name; }));
  kinds_of_drives().push_back(kind);
  return true;
}

}  // namespace ropewalk
