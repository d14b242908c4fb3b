// Files are written whole or not at all.
#pragma once

#include <string>
#include <string_view>

namespace ropewalk {

// Throws InputError when it cannot be read.
std::string read_file(const std::string& path);

// Writes a temporary file beside `path`, flushes it to the disk and renames it. Throws InputError (disk full,
// no permission, ...) and leaves an existing file untouched.
void write_file_atomically(const std::string& path, std::string_view content);

// Throws InputError where a file that an option names exists, unless `force` is set.
void refuse_existing(const std::string& path, const std::string& option, bool force);

// xxh64 as 16 hex digits.
std::string hash_hex(std::string_view content);

}  // namespace ropewalk
