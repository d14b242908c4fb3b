#include "run/directory_lock.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/utsname.h>

#include <cerrno>
#include <ctime>

#include "io/files.hpp"
#include "io/toml_table.hpp"

namespace ropewalk {
namespace {

std::string this_process() {
  const std::time_t t = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&t, &utc);
  char since[32];
  std::strftime(since, sizeof since, "%Y-%m-%d %H:%M:%S UTC", &utc);
  utsname system{};
  uname(&system);
  return fmt::format("process {} on {} since {}", ::getpid(), system.nodename, since);
}

// Its holder may have removed the file after we had opened it.
bool is_still_there(int fd, const std::string& path) {
  struct stat ours {
  }, there{};
  return ::fstat(fd, &ours) == 0 && ::stat(path.c_str(), &there) == 0 && ours.st_ino == there.st_ino &&
         ours.st_dev == there.st_dev;
}

}  // namespace

DirectoryLock::DirectoryLock(const std::string& directory) : path_(directory + "/" + lock_name) {
  for (bool locked = false; !locked; locked = is_still_there(file_.get(), path_)) {
    file_ = Descriptor(uninterrupted([&] { return ::open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666); }));
    if (!file_.open()) throw file_error(path_, "cannot be written", errno);
    if (uninterrupted([&] { return ::flock(file_.get(), LOCK_EX | LOCK_NB); }) == 0) continue;
    if (errno != EWOULDBLOCK) break;
    const std::string holder = printable(read_file(path_), 120);
    file_ = Descriptor();
    throw InputError({directory, 0, ""}, "is in use by " + (holder.empty() ? "another process" : holder),
                     "wait for its end, or end it");
  }
  // It says who we are; where this cannot be written, it locks all the same.
  if (::ftruncate(file_.get(), 0) == 0) write_all(file_.get(), this_process());
}

DirectoryLock::~DirectoryLock() {
  if (file_.open()) uninterrupted([&] { return ::unlink(path_.c_str()); });
}

}  // namespace ropewalk
