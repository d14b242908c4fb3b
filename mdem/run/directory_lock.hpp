// One process at a time writes in the directory of a run; several may work in that of a campaign.
#pragma once

#include <string>

#include "io/descriptor.hpp"

namespace ropewalk {

inline constexpr const char* lock_name = "lock";  // name of the file in the directory

// A lock on the file `lock`, which holds the name of the process. The lock of a process that was killed ends with
// it; the file then stays, and the next one takes it over. Where the file system knows no locks the file alone
// counts, as long as its process lives; that of a process on another machine counts until it is removed.
class DirectoryLock {
 public:
  enum class Kind {
    alone,
    together,  // with others of this kind; the last one removes the file
  };

  DirectoryLock() = default;
  // Throws InputError that names the process that has it.
  explicit DirectoryLock(const std::string& directory, Kind kind = Kind::alone);
  DirectoryLock(DirectoryLock&& other) noexcept;
  DirectoryLock& operator=(DirectoryLock&& other) noexcept;
  ~DirectoryLock();

 private:
  std::string path_;  // path of the file that is removed at the end; empty: none
  Descriptor file_;
};

// The process that holds the directory alone, "process 12 on a since ..."; empty: none does.
std::string holder_of(const std::string& directory);
// Whether this is the name of a file that such a lock leaves in the directory.
bool is_lock_file(const std::string& name);

}  // namespace ropewalk
