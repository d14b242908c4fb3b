// One process at a time writes in the directory of a run.
#pragma once

#include <string>

#include "io/descriptor.hpp"

namespace ropewalk {

inline constexpr const char* lock_name = "lock";  // of the file in the directory

// A lock on the file `lock`, which holds the name of the process and is removed at the end. The lock of a process
// that was killed ends with it; the file then stays, and the next one takes it over.
class DirectoryLock {
 public:
  DirectoryLock() = default;
  // Throws InputError that names the process that has it. Where the file system knows no locks, there is none.
  explicit DirectoryLock(const std::string& directory);
  DirectoryLock(DirectoryLock&& other) noexcept = default;
  DirectoryLock& operator=(DirectoryLock&& other) noexcept = default;
  ~DirectoryLock();

 private:
  std::string path_;
  Descriptor file_;
};

}  // namespace ropewalk
