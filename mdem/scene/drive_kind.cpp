#include "scene/drive_kind.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "model/error.hpp"
#include "scene/own_parts.hpp"
#include "scene/scene.hpp"
#include "sim/forces/shipped_terms.hpp"

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
      thermostat_drive(), twist_drive(),    grip_drive(),  load_drive(),    periodic_drive(),
      tether_drive(),     friction_drive(), links_drive(), failure_drive(),
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

int element_of_tube(const Topology& topology, int tube, int element, const InputError::Place& place) {
  const auto fail = [&](const std::string& what, int count) {
    throw InputError(place, what, fmt::format("they are 0 to {}", count - 1));
  };
  if (tube < 0 || tube >= topology.tubes()) fail(fmt::format("there is no tube {}", tube), topology.tubes());
  const int length = topology.length_of(tube), at = element < 0 ? length + element : element;
  if (at < 0 || at >= length) fail(fmt::format("tube {} has no element {}", tube, element), length);
  return topology.tube_begin[static_cast<std::size_t>(tube)] + at;
}

std::vector<int> pair_of_types(const TomlTable& t, const Scene& scene) {
  std::vector<int> pair;
  if (!t.has("types")) return pair;
  const auto sets = static_cast<long>(scene.sets.size());
  for (const long type : t.integers("types", 0, 1000)) {
    if (type >= sets)
      throw t.error("types", fmt::format("there is no tube type {}", type),
                    fmt::format("they are 0 to {}", sets - 1));
    pair.push_back(static_cast<int>(type));
  }
  if (pair.size() != 2) throw t.error("types", "must have two entries", "write [0, 1], or [0, 0] for like tubes");
  return pair;
}

std::string words_of(const TypePairs& pairs) {
  if (!pairs.named.empty()) return fmt::format(" between types {} and {}", pairs.named[0], pairs.named[1]);
  std::string but;
  for (const auto& [a, b] : pairs.without) but += fmt::format("{}{} and {}", but.empty() ? "" : ", ", a, b);
  return but.empty() ? "" : " between all types but " + but;
}

void read_listed_drives(const DriveKind& kind, const std::vector<TomlTable>& tables, Scene& scene) {
  std::vector<std::pair<std::pair<int, int>, std::size_t>> named;  // pairs, and the tables that name them
  std::optional<std::size_t> rest;                                 // the table that names none
  const auto refuse = [&](std::size_t table, std::size_t other, const std::string& what) {
    throw tables[table].error("types",
                              fmt::format("{} as {} of line {}", what, kind.table().header(), tables[other].line()),
                              "put both into one table, or give one of them other types");
  };
  for (std::size_t k = 0; k < tables.size(); ++k) {
    scene.drives.push_back(kind.read(tables[k], scene));
    const std::vector<int>* types = scene.drives.back()->types();
    if (!types) continue;
    if (types->empty()) {
      if (rest) refuse(k, *rest, "is missing, so that the table claims all pairs of types,");
      rest = k;
      continue;
    }
    const auto [a, b] = std::minmax(types->front(), types->back());
    for (const auto& [pair, table] : named)
      if (pair == std::pair(a, b)) refuse(k, table, fmt::format("is [{}, {}], the same pair", a, b));
    named.push_back({{a, b}, k});
  }
  if (!rest || named.empty()) return;
  const std::size_t types = scene.sets.size();
  if (named.size() == types * (types + 1) / 2)
    throw tables[*rest].error("types",
                              "is missing, and other tables name all pairs of types: this one would do nothing",
                              "take the table away, or one of the others");
  std::vector<std::pair<int, int>> pairs;
  for (const auto& [pair, table] : named) pairs.push_back(pair);
  auto& drive = scene.drives[scene.drives.size() - tables.size() + *rest];
  drive = drive->without(pairs);
}

namespace {

std::vector<TermKind> terms_of_shipped_drives() {
  std::vector<TermKind> kinds;
  for (const DriveKind& drive : shipped_drives())
    if (auto kind = term_kind_of(drive)) kinds.push_back(*std::move(kind));
  // In no table: the first follows from the strands of a scene, the second is given in Python.
  kinds.push_back({"ends", "van der Waals energy of the ends of tubes in line"});
  kinds.push_back({"own_forces", "energy of forces of one's own, in Python"});
  return kinds;
}

}  // namespace

// Programs that link this library have this file, even if they only read logs, by this name (mdem/CMakeLists.txt).
extern "C" bool ropewalk_shipped_terms;
bool ropewalk_shipped_terms = set_shipped_terms(&terms_of_shipped_drives);

bool Drive::holds_elements() const {
  if (ends() == Ends::clamped || ends() == Ends::loaded) return true;
  const SceneTable keys = table();
  return std::any_of(keys.keys.begin(), keys.keys.end(), [](const SceneKey& key) { return key.numbers_elements; });
}

const std::vector<DriveKind>& drive_kinds() { return kinds_of_drives(); }

bool add_drive_kind(DriveKind kind) {
  add_own_part(kinds_of_drives(), kind, "drive", [](const DriveKind& k) { return k.table().name; });
  if (auto term = term_kind_of(kind)) add_term_kind(*std::move(term));
  return true;
}

}  // namespace ropewalk
