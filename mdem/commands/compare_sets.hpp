// Parameter sets side by side.
#pragma once

#include <string>
#include <vector>

namespace ropewalk {

// Prints the table of these sets (files, or names of shipped ones), as JSON where asked, and writes a page (HTML)
// unless `page` is empty. Returns the exit code. Throws InputError.
int compare_sets(const std::vector<std::string>& names, const std::string& page, bool json, bool force);

}  // namespace ropewalk
