// The prose of a case, `case.md` in its folder GROUP/NAME/, and its scene, `scene.toml`. The build puts these files into
// the program.
//
//   # Title
//   ## Why
//   ## Set-up
//   ## Oracle
//   ## Literature       a list, one work an item
//   ## Remarks          a list; may be left out if the case returns remarks of its own
//
// Lines of one paragraph or item are joined. {tube} stands for the tubes of the run, and formulas stand between
// backquotes (report/formula.hpp).
#pragma once

#include <string>
#include <vector>

namespace ropewalk::validate {

struct CaseText {
  std::string group, name;  // "theory", "euler-buckling"
  std::string title, why, setup, oracle, literature;
  std::vector<std::string> remarks;
};

// `path`: ".../GROUP/NAME/case.md". Throws InputError with the line of what is wrong.
CaseText parse_case_text(const std::string& path, const std::string& text);

// Registers a text before main() begins. validate/embed_texts.cmake writes one for each case.md and scene.toml.
struct RegisteredText {
  RegisteredText(const char* path, const char* text);
};

// The registered text of a file by its path from validate/ on, as "chart/models.toml". Throws std::out_of_range if there is
// none.
std::string registered_text(const std::string& path);

// The registered scene.toml of a case. Throws std::out_of_range if it has none.
std::string case_scene(const std::string& name);

// The registered text of a case; null if there is none.
const CaseText* find_case_text(const std::string& name);

}  // namespace ropewalk::validate
