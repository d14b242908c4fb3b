// Parts of a program of one's own: drives, loads, contact laws and scene kinds that no other program has.
#pragma once

#include <string>
#include <vector>

namespace ropewalk {

// Ends the program with one line and exit code 2 where a name is taken. Parts register before main() begins, where
// nothing catches an exception. `what`: "load".
void refuse_taken_name(bool taken, const char* what, const std::string& name);

// The same; else this program has the part from now on.
void register_own_part(bool taken, const char* what, const std::string& name);
bool is_own_part(const std::string& what, const std::string& name);

// The name under which this program was started.
std::string own_program();

// Throws InputError for the run in `path`, by `program` with these parts ("load wind, drive trap"), where this program
// lacks one of them.
void refuse_missing_parts(const std::string& parts, const std::string& program, const std::string& path);

}  // namespace ropewalk
