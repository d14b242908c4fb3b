// Parts of a program of one's own: drives, loads, contact laws and scene kinds that no other program has.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace ropewalk {

// Ends the program with one line and exit code 2 where a name is taken. Parts register before main() begins, where
// nothing catches an exception. `what`: "load".
void refuse_taken_name(bool taken, const char* what, const std::string& name);

// Calls refuse_taken_name(), then notes that this program has the part.
void register_own_part(bool taken, const char* what, const std::string& name);
// Adds a part to the end of its register. Returns true, so that a static variable can add it.
template <class Kind, class NameOf>
bool add_own_part(std::vector<Kind>& kinds, Kind kind, const char* what, const NameOf& name_of) {
  bool taken = false;
  for (const Kind& other : kinds) taken = taken || name_of(other) == name_of(kind);
  register_own_part(taken, what, name_of(kind));
  kinds.push_back(std::move(kind));
  return true;
}
bool is_own_part(const std::string& what, const std::string& name);

// The name under which this program was started.
std::string own_program();

// Throws InputError for the run in `path`, by `program` with these parts ("load wind, drive trap"), where this program
// lacks one of them.
void refuse_missing_parts(const std::string& parts, const std::string& program, const std::string& path);

}  // namespace ropewalk
