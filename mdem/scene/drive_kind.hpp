// The register of drives (scene/drive.hpp). A drive is one file, or a pair, with its class, its keys and its entry
// here.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "io/toml_table.hpp"
#include "scene/drive.hpp"
#include "sim/forces/force_term.hpp"
#include "sim/forces/terms/type_pairs.hpp"

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

  // A drive with force terms describes how tubes interact: the numbers of its table are properties, which may have
  // a standard error (input_numbers.hpp). Other drives say what is done to them.
  bool has_properties() const { return energy != nullptr; }
};

// The number of an element of a tube in the scene; a negative one counts from the end of the tube. Throws
// InputError at the place where there is no such tube or element.
int element_of_tube(const Topology& topology, int tube, int element, const InputError::Place& place);

// Reads the key `types`: two tube types, or an empty list where the table does not have this key. Throws InputError
// for types that the scene does not have.
std::vector<int> pair_of_types(const TomlTable& t, const Scene& scene);

// Pairs of types in words, for Drive::words(): " between types 0 and 1", or nothing where they are all.
std::string words_of(const TypePairs& pairs);

// Appends the drives of these tables, all of this kind, to those of the scene. A pair of types belongs to the one
// table that names it, and all other pairs to the one that names none (Drive::types). Throws InputError where two
// tables claim the same pair.
void read_listed_drives(const DriveKind& kind, const std::vector<TomlTable>& tables, Scene& scene);

// All kinds of drives, in the order of help and templates.
const std::vector<DriveKind>& drive_kinds();
// For drives from elsewhere; returns true, so that a static variable can do it. The table's name must be new.
bool add_drive_kind(DriveKind kind);

}  // namespace ropewalk
