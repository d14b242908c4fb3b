// Files are written whole or not at all.
#pragma once

#include <fstream>
#include <string>
#include <string_view>

#include "io/descriptor.hpp"
#include "model/error.hpp"

namespace ropewalk {

// The content of a regular file, or of standard input by the name /dev/stdin. Throws InputError when the file
// cannot be read, is a pipe or a device, which may never end, and when standard input gives more than 256 MiB.
std::string read_file(const std::string& path);

// Has what was written to a file on the disk. False, with errno: it failed. A file system that cannot do it is no
// failure, and leaves a note.
bool flush_to_disk(int fd);
// What a file system could not do, for one line at the end of a program; empty: nothing, or it was asked for
// before.
std::string note_of_files();

// Says how to remedy an error of the system, by its number.
const char* remedy_for_errno(int code);
// A stream of a regular file, for files that are read piece by piece. Throws as opened_to_read().
std::ifstream opened_stream(const std::string& path);
// Refuses anything but a regular file: a device may have no end.
void refuse_devices(const std::string& path);

// Writes a temporary file beside `path`, flushes it to the disk and renames it. Throws InputError (disk full,
// no permission, ...) and leaves an existing file untouched.
void write_file_atomically(const std::string& path, std::string_view content);

// Makes an empty file beside `path` under a name that was free, for what is renamed to `path` once it is whole.
std::string new_part_of(const std::string& path);
// The name of the file that a process was writing when it left one of this name; empty for any other name.
std::string without_part(const std::string& name);

// "cannot be written: No space left on device", with a remedy. code: errno.
InputError file_error(const std::string& path, const char* what, int code);
// Throws InputError where the path is there and is no regular file, or no directory: a link leads to other people's
// files, and a pipe has no end.
void refuse_strange(const std::string& path, bool directory = false);
// A file that is written in place, made where it is not there; `flags`: O_RDWR or O_WRONLY, and others. Throws
// InputError where it is a link, not a regular file, or one with a second name, which would be written as well.
Descriptor opened_to_write(const std::string& path, int flags);
// Throws InputError where the file cannot be opened, or is not a regular one. Never waits for a pipe.
Descriptor opened_to_read(const std::string& path);

// Throws InputError where a file that an option names exists, unless `force` is set.
void refuse_existing(const std::string& path, const std::string& option, bool force);

// xxh64 as 16 hex digits.
std::string hash_hex(std::string_view content);

}  // namespace ropewalk
