#include "io/files.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <list>
#include <utility>

#include "io/file_group.hpp"

#define XXH_INLINE_ALL
#include <xxhash.h>

namespace ropewalk {
namespace {

constexpr const char* not_written = "cannot be written";
constexpr const char* part = ".part-";                          // of the name of a file that is being written
constexpr std::size_t longest_stream = std::size_t{256} << 20;  // bytes of a file that is not a regular one

const char* remedy_for(int code) {
  switch (code) {
    case ENOENT:
      return "check the name, and that the directory exists";
    case ENOTDIR:
      return "a part of the path is a file; choose another path";
    case EISDIR:
      return "name a file, not a directory";
    case EACCES:
    case EPERM:
      return "check the permissions of the file and its directory";
    case EROFS:
      return "the file system is read-only; choose another place";
    case ENOSPC:
    case EDQUOT:
      return "free some space on the disk, or choose another place";
    case EFBIG:
      return "the limit on the size of files is reached; raise it (ulimit -f) or choose another place";
    case EMFILE:
    case ENFILE:
      return "close other files and programs, or raise the limit (ulimit -n)";
    case ENOMEM:
      return "free some memory, or raise the limit (ulimit -v)";
    case EPIPE:
      return "the program that reads it has ended";
    default:
      return "check the disk and the path";
  }
}

// A new file in the same directory, since rename() does not cross file systems. O_EXCL: no other process has it.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& path) : fd_(-1) {
    static std::atomic<unsigned> counter{0};
    do {
      name_ = fmt::format("{}{}{}-{}", path, part, ::getpid(), counter++);
      fd_ = uninterrupted([&] { return ::open(name_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666); });
    } while (fd_ < 0 && errno == EEXIST);
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() {
    if (fd_ >= 0 && !renamed_) ::unlink(name_.c_str());
  }

  int descriptor() const { return fd_; }
  // Closed, and not removed.
  std::string keep() {
    ::close(std::exchange(fd_, -1));
    return name_;
  }
  bool rename_to(const std::string& path) {
    renamed_ = uninterrupted([&] { return ::rename(name_.c_str(), path.c_str()); }) == 0;
    return renamed_;
  }

 private:
  std::string name_;
  int fd_;
  bool renamed_ = false;
};

// The rename must reach the disk as well. Some file systems cannot flush a directory; this is not an error, since
// the file is whole either way.
void flush_directory_of(const std::string& path) {
  const std::size_t slash = path.rfind('/');
  const std::string directory = slash == std::string::npos ? "." : slash == 0 ? "/" : path.substr(0, slash);
  const Descriptor fd(uninterrupted([&] { return ::open(directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC); }));
  if (fd.open()) uninterrupted([&] { return ::fsync(fd.get()); });
}

// Closed, and on the disk.
void fill_part(const TemporaryFile& temporary, const std::string& path, std::string_view content) {
  Descriptor fd(temporary.descriptor());
  if (!fd.open()) throw file_error(path, not_written, errno);
  struct stat old {};
  if (::lstat(path.c_str(), &old) == 0 && S_ISREG(old.st_mode) && ::fchmod(fd.get(), old.st_mode & 0777) != 0)
    throw file_error(path, not_written, errno);
  if (!write_all(fd.get(), content)) throw file_error(path, not_written, errno);
  if (uninterrupted([&] { return ::fsync(fd.get()); }) != 0) throw file_error(path, not_written, errno);
  if (fd.close() != 0 && errno != EINTR)
    throw file_error(path, not_written, errno);  // where interrupted it is closed
}

}  // namespace

InputError file_error(const std::string& path, const char* what, int code) {
  return InputError({path, 0, ""}, fmt::format("{}: {}", what, std::strerror(code)), remedy_for(code));
}

void refuse_strange(const std::string& path, bool directory) {
  struct stat status {};
  if (::lstat(path.c_str(), &status) != 0) return;
  if (directory ? S_ISDIR(status.st_mode) : S_ISREG(status.st_mode)) return;
  throw InputError(
      {path, 0, ""},
      S_ISLNK(status.st_mode) ? "is a link, which may lead anywhere"
      : directory             ? "is no directory"
                              : "is no regular file",
      directory ? "put the directory itself here, or take it away" : "put the file itself here, or take it away");
}

Descriptor opened_to_write(const std::string& path, int flags) {
  refuse_strange(path);
  // A pipe that took its place meanwhile would hold open() up.
  Descriptor file(uninterrupted(
      [&] { return ::open(path.c_str(), flags | O_CREAT | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC, 0666); }));
  if (!file.open()) throw file_error(path, not_written, errno);
  struct stat status {};
  if (::fstat(file.get(), &status) != 0) throw file_error(path, not_written, errno);
  if (!S_ISREG(status.st_mode)) throw InputError({path, 0, ""}, "is no regular file", "take it away");
  if (status.st_nlink > 1)
    throw InputError({path, 0, ""}, "has a second name (a hard link), and that file would be written as well",
                     "replace it by a copy: cp FILE NEW && mv NEW FILE");
  return file;
}

Descriptor opened_to_read(const std::string& path) {
  Descriptor file(uninterrupted([&] { return ::open(path.c_str(), O_RDONLY | O_CLOEXEC); }));
  if (!file.open()) throw file_error(path, "cannot be opened", errno);
  return file;
}

std::string read_file(const std::string& path) {
  const Descriptor fd = opened_to_read(path);
  struct stat status {};
  if (::fstat(fd.get(), &status) != 0) throw file_error(path, "cannot be read", errno);
  std::string content;
  if (status.st_size > 0) content.reserve(static_cast<std::size_t>(status.st_size) + 1);
  char buffer[1 << 16];
  for (;;) {
    const ssize_t n = uninterrupted([&] { return ::read(fd.get(), buffer, sizeof buffer); });
    if (n < 0) throw file_error(path, "cannot be read", errno);
    if (n == 0) return content;
    if (!S_ISREG(status.st_mode) && content.size() >= longest_stream)
      throw InputError({path, 0, ""},
                       fmt::format("is no file, and has not ended after {} MiB", longest_stream >> 20),
                       "name a file");
    content.append(buffer, static_cast<std::size_t>(n));
  }
}

void write_file_atomically(const std::string& path, std::string_view content, const std::string& keep_old_as) {
  TemporaryFile temporary(path);
  fill_part(temporary, path, content);
  if (!keep_old_as.empty() && uninterrupted([&] { return ::rename(path.c_str(), keep_old_as.c_str()); }) != 0 &&
      errno != ENOENT)
    throw file_error(keep_old_as, not_written, errno);
  if (!temporary.rename_to(path)) throw file_error(path, not_written, errno);
  flush_directory_of(path);
}

void write_files_together(const std::vector<std::pair<std::string, std::string>>& files) {
  std::list<TemporaryFile> parts;
  for (const auto& [path, content] : files) fill_part(parts.emplace_back(path), path, content);
  auto at = parts.begin();
  for (const auto& [path, content] : files) {
    if (!(at++)->rename_to(path)) throw file_error(path, not_written, errno);
    flush_directory_of(path);
  }
}

std::string new_part_of(const std::string& path) {
  TemporaryFile temporary(path);
  if (temporary.descriptor() < 0) throw file_error(path, not_written, errno);
  return temporary.keep();
}

std::string without_part(const std::string& name) {
  const std::size_t at = name.rfind(part);
  if (at == std::string::npos || at == 0) return "";
  const std::string number = name.substr(at + std::strlen(part));
  return number.find_first_not_of("0123456789-") == std::string::npos ? name.substr(0, at) : "";
}

const char* remedy_for_errno(int code) { return remedy_for(code); }

void refuse_devices(const std::string& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) throw file_error(path, "cannot be opened", errno);
  if (!S_ISREG(status.st_mode)) throw InputError({path, 0, ""}, "is not a regular file", "name a file");
}

void refuse_existing(const std::string& path, const std::string& option, bool force) {
  if (!force && ::access(path.c_str(), F_OK) == 0)
    throw InputError({path, 0, option}, "exists", "choose another name, or give --force to replace it");
}

std::string hash_hex(std::string_view content) {
  return fmt::format("{:016x}", static_cast<std::uint64_t>(XXH64(content.data(), content.size(), 0)));
}

}  // namespace ropewalk
