// docs/limits.md in the program: what `help` says of a limit.
#pragma once

#include <string>
#include <vector>

namespace ropewalk {

extern const char* const limits_page;  // CMake writes it

// The headings below which a limit is explained: the keys of limit_kinds(), and "slip".
std::vector<std::string> limit_headings();
// The part below the heading `limit`, as it stands; empty: the page has none.
std::string limit_help(const std::string& limit);

}  // namespace ropewalk
