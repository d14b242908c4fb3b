// Messages of a program on the way. It goes on where nobody can read it: on a full disk, to a reader that went
// away.
#pragma once

#include <string>

namespace ropewalk {

// To standard error, as it is.
void tell_as_is(const std::string& text);

// A line of its own, "ropewalk: LINE", above the progress line where there is one.
void tell(const std::string& line);

// To standard output.
void print(const std::string& text);

}  // namespace ropewalk
