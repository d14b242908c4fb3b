// Names in the registers of drives, loads, contact laws and scene kinds.
#pragma once

#include <string>

namespace ropewalk {

// Ends the program with one line and exit code 2 where a part of one's own has a name that is taken. Parts register
// before main() begins, where nothing catches an exception. `what`: "load".
void refuse_taken_name(bool taken, const char* what, const std::string& name);

}  // namespace ropewalk
