// What docs/tables.md and docs/theory.md say of the tables of a scene, in the program: `help` prints it, and the
// site makes its pages of it.
#pragma once

#include <string>
#include <vector>

#include "scene/scene_key.hpp"

namespace ropewalk {

extern const char *const tables_page, *const theory_page;  // CMake writes them

struct TablePart {
  std::string heading;  // empty: what the table is for
  std::string text;     // Markdown, whose links are those of a page in docs/; empty: the pages say nothing
};
// "", Syntax, Example, Formula, Keys, Does not go with, Related. The text of "Keys" is set for a terminal.
std::vector<TablePart> table_parts(const SceneTable& table);

// All parts of the scene's table of this name, as in "links" or "[links]"; "top" is the top of the file. Empty:
// there is no such table.
std::string table_help(const std::string& name);
// The keys of the load of this kind; empty: there is no such kind.
std::string load_help(const std::string& name);
// The names below which docs/tables.md has a section.
std::vector<std::string> described_tables();

}  // namespace ropewalk
