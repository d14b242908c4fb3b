// The register of drives (scene/drive.hpp). A drive is one file, or a pair, with its class, its keys and its entry
// here.
#pragma once

#include <memory>
#include <vector>

#include "io/toml_table.hpp"
#include "scene/drive.hpp"
#include "sim/forces/force_term.hpp"

namespace ropewalk {

struct DriveKind {
  SceneTable (*table)();  // with the keys of all drives of this kind
  // `scene` holds its elements and what precedes the drives in help.
  std::shared_ptr<const Drive> (*read)(const TomlTable&, const Scene& scene);
  // Describes the energy of its force terms, which have the name of the table; the log then has the column NAME_eV.
  // Null: it has no terms. No words: its terms store no energy, and there is no such column.
  const char* energy = nullptr;
  // More columns, of what these terms have done.
  std::vector<TermColumn> account = {};
};

// The number of an element of a tube in the scene; a negative one counts from the end of the tube. Throws
// InputError at the place where there is no such tube or element.
int element_of_tube(const Topology& topology, int tube, int element, const InputError::Place& place);

// Reads the key `types`: two tube types, or an empty list where the table does not have this key. Throws InputError
// for types that the scene does not have.
std::vector<int> pair_of_types(const TomlTable& t, const Scene& scene);

// In the order of help and templates.
const std::vector<DriveKind>& drive_kinds();
// For drives from elsewhere; returns true, so that a static variable can do it. The table's name must be new.
bool add_drive_kind(DriveKind kind);

}  // namespace ropewalk
