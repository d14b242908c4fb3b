#include "run/directory_lock.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/utsname.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <utility>

#include "io/files.hpp"
#include "io/plain_text.hpp"
#include "model/error.hpp"

namespace ropewalk {
namespace {

namespace fs = std::filesystem;

constexpr const char* alone_name = "lock-alone";  // where the file system knows no locks

std::string machine() {
  utsname system{};
  uname(&system);
  return system.nodename;
}

std::string this_process() {
  const std::time_t t = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&t, &utc);
  char since[32];
  std::strftime(since, sizeof since, "%Y-%m-%d %H:%M:%S UTC", &utc);
  return fmt::format("process {} on {} since {}", ::getpid(), machine(), since);
}

// False: it has ended. That of another machine, or one that is not named, may be alive.
bool may_be_alive(const std::string& holder) {
  const std::string begin = "process ";
  if (holder.rfind(begin, 0) != 0) return true;
  const auto id = static_cast<pid_t>(std::atol(holder.c_str() + begin.size()));
  if (holder.find(fmt::format(" {} on {} since ", id, machine())) != begin.size() - 1) return true;
  return id > 0 && (::kill(id, 0) == 0 || errno != ESRCH);
}

enum class Locked { yes, no, unknown };  // unknown: the file system has no locks

Locked try_lock(int file, int how) {
  if (uninterrupted([&] { return ::flock(file, how | LOCK_NB); }) == 0) return Locked::yes;
  return errno == EWOULDBLOCK ? Locked::no : Locked::unknown;
}

// Its holder may have removed the file after we had opened it.
bool is_still_there(int fd, const std::string& path) {
  struct stat ours {
  }, there{};
  return ::fstat(fd, &ours) == 0 && ::stat(path.c_str(), &there) == 0 && ours.st_ino == there.st_ino &&
         ours.st_dev == there.st_dev;
}

std::string named_in(const std::string& path) {
  refuse_strange(path);
  return printable(read_file(path), 120);
}

InputError in_use(const std::string& directory, const std::string& holder, const std::string& file = "") {
  return InputError({directory, 0, ""}, "is in use by " + (holder.empty() ? "another process" : holder),
                    "wait for its end, or end it" + (file.empty() ? "" : "; where it has ended, remove " + file));
}

// Makes the file, which says who we are. False: it is there already.
bool made_lock_file(const std::string& path) {
  const Descriptor file(
      uninterrupted([&] { return ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666); }));
  if (!file.open() && errno != EEXIST) throw file_error(path, "cannot be written", errno);
  return file.open() && write_all(file.get(), this_process());
}

// Throws where a process that may be alive is named in such a file beside ours; removes those of dead ones.
void refuse_other_files(const std::string& directory, const std::string& ours, bool together_as_well) {
  std::error_code error;
  for (fs::directory_iterator at(directory, error), end; !error && at != end; at.increment(error)) {
    const std::string name = at->path().filename().string(), path = at->path().string();
    if (path == ours || !is_lock_file(name) || name == lock_name) continue;
    if (name != alone_name && !together_as_well) continue;
    const std::string holder = named_in(path);
    if (may_be_alive(holder)) throw in_use(directory, holder, path);
    ::unlink(path.c_str());
  }
}

// Without locks of the system the files count by being there.
std::string taken_by_file(const std::string& directory, bool alone) {
  const std::string path =
      directory + "/" + (alone ? alone_name : fmt::format("{}-{}-{}", lock_name, machine(), ::getpid()));
  while (!made_lock_file(path)) {
    const std::string holder = named_in(path);
    if (alone && may_be_alive(holder)) throw in_use(directory, holder, path);
    if (::unlink(path.c_str()) != 0 && errno != ENOENT) throw file_error(path, "cannot be removed", errno);
  }
  try {
    refuse_other_files(directory, path, alone);
  } catch (const InputError&) {
    ::unlink(path.c_str());
    throw;
  }
  return path;
}

}  // namespace

bool is_lock_file(const std::string& name) {
  if (name == lock_name || name == alone_name) return true;
  const std::string begin = std::string(lock_name) + "-";
  const std::size_t dash = name.rfind('-');
  return name.rfind(begin, 0) == 0 && dash > begin.size() && dash + 1 < name.size() &&
         name.find_first_not_of("0123456789", dash + 1) == std::string::npos;
}

std::string holder_of(const std::string& directory) {
  const std::string path = directory + "/" + lock_name, by_file = directory + "/" + alone_name;
  std::error_code error;
  if (fs::exists(by_file, error)) {
    const std::string holder = named_in(by_file);
    return may_be_alive(holder) ? holder : "";
  }
  if (!fs::exists(path, error)) return "";
  refuse_strange(path);
  const Descriptor file = opened_to_read(path);
  return try_lock(file.get(), LOCK_SH) == Locked::no ? named_in(path) : "";
}

DirectoryLock::DirectoryLock(const std::string& directory, Kind kind) {
  const std::string path = directory + "/" + lock_name;
  const bool alone = kind == Kind::alone;
  for (bool locked = false; !locked; locked = is_still_there(file_.get(), path)) {
    file_ = opened_to_write(path, O_RDWR);
    const Locked result = try_lock(file_.get(), alone ? LOCK_EX : LOCK_SH);
    if (result == Locked::yes) continue;
    file_ = Descriptor();
    if (result == Locked::no) throw in_use(directory, named_in(path));
    ::unlink(path.c_str());
    path_ = taken_by_file(directory, alone);
    return;
  }
  path_ = path;
  if (!alone) return;
  // It says who we are; where this cannot be written, it locks all the same.
  if (::ftruncate(file_.get(), 0) == 0) write_all(file_.get(), this_process());
}

DirectoryLock::DirectoryLock(DirectoryLock&& other) noexcept
    : path_(std::exchange(other.path_, "")), file_(std::move(other.file_)) {}

DirectoryLock& DirectoryLock::operator=(DirectoryLock&& other) noexcept {
  std::swap(path_, other.path_);
  std::swap(file_, other.file_);
  return *this;
}

DirectoryLock::~DirectoryLock() {
  const bool others_hold_it = file_.open() && try_lock(file_.get(), LOCK_EX) != Locked::yes;
  if (!path_.empty() && !others_hold_it) uninterrupted([&] { return ::unlink(path_.c_str()); });
}

}  // namespace ropewalk
