// Files that belong together.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace ropewalk {

// Writes each text to its path, as write_file_atomically() does (io/files.hpp); all are on the disk before the
// first is renamed, in their order. Throws InputError, and leaves the files as they were where one of them has no
// room.
void write_files_together(const std::vector<std::pair<std::string, std::string>>& files);

}  // namespace ropewalk
