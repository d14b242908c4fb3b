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

#include "io/draft.hpp"
#include "io/file_group.hpp"

#define XXH_INLINE_ALL
#include <xxhash.h>

namespace ropewalk {
namespace {

constexpr const char* not_written = "cannot be written";
constexpr const char* part = ".part-";  // part of the name of a file that is being written
constexpr const char* standard_input = "/dev/stdin";
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

// Makes what has a free name in the same directory, since rename() does not cross file systems. The name; empty,
// with errno: it cannot be made. `make`: fails with EEXIST where the name is taken.
template <class Make>
std::string made_beside(const std::string& path, const Make& make) {
  static std::atomic<unsigned> counter{0};
  std::string name;
  do {
    name = fmt::format("{}{}{}-{}", path, part, ::getpid(), counter++);
    if (uninterrupted([&] { return make(name.c_str()); }) >= 0) return name;
  } while (errno == EEXIST);
  return "";
}

// The rename must reach the disk as well. Some file systems cannot flush a directory; this is not an error, since
// the file is whole either way.
void flush_directory_of(const std::string& path) {
  const std::size_t slash = path.rfind('/');
  const std::string directory = slash == std::string::npos ? "." : slash == 0 ? "/" : path.substr(0, slash);
  const Descriptor fd(uninterrupted([&] { return ::open(directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC); }));
  if (fd.open()) uninterrupted([&] { return ::fsync(fd.get()); });
}

std::atomic<const char*> system_note{nullptr};

// FAT has no permissions, and some file systems of networks and of FUSE do not flush.
bool not_done_here(int code) {
  return code == EPERM || code == EINVAL || code == ENOSYS || code == EOPNOTSUPP || code == ENOTTY;
}

FileError error_of(const std::string& path, const char* what) {
  const int code = errno;
  return {file_error(path, what, code), code};
}

}  // namespace

bool flush_to_disk(int fd) {
  if (uninterrupted([&] { return ::fdatasync(fd); }) == 0) return true;
  if (errno == EPERM || !not_done_here(errno)) return false;
  system_note = "the file system does not flush files to the disk: a power cut may lose what was written last";
  return true;
}

std::string note_of_files() {
  const char* const said = system_note.exchange(nullptr);
  return said ? said : "";
}

InputError file_error(const std::string& path, const char* what, int code) {
  return InputError({path, 0, ""}, fmt::format("{}: {}", what, std::strerror(code)), remedy_for(code));
}

Draft::Draft(std::string path) : path_(std::move(path)) {
  // O_EXCL: no other process has it.
  name_ = made_beside(path_, [this](const char* name) {
    file_ = Descriptor(::open(name, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
    return file_.get();
  });
  if (name_.empty()) throw error_of(path_, not_written);
}

Draft::~Draft() {
  if (!replaced_) ::unlink(name_.c_str());
}

void Draft::take_permissions() {
  struct stat old {};
  if (::lstat(path_.c_str(), &old) != 0 || !S_ISREG(old.st_mode)) return;
  if (uninterrupted([&] { return ::fchmod(file_.get(), old.st_mode & 0777); }) == 0) return;
  if (!not_done_here(errno)) throw error_of(path_, not_written);
  system_note = "the file system keeps no permissions: files have those that it gives them";
}

void Draft::write(std::string_view content) {
  take_permissions();
  if (!write_all(file_.get(), content)) throw error_of(path_, not_written);
}

void Draft::patch(std::uint64_t at, std::string_view bytes) {
  if (!write_all_at(file_.get(), bytes, at)) throw error_of(path_, not_written);
}

void Draft::need_room() const {
  // More than programs write at a time: where they found no room, this finds none.
  const std::string some(1 << 17, ' ');
  Descriptor file(uninterrupted([&] { return ::open(name_.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC); }));
  if (!file.open() || !write_all(file.get(), some) || !flush_to_disk(file.get()))
    throw error_of(path_, not_written);
}

void Draft::sync() {
  if (!file_.open()) return;
  take_permissions();
  if (!flush_to_disk(file_.get())) throw error_of(path_, not_written);
  if (file_.close() != 0 && errno != EINTR) throw error_of(path_, not_written);  // where interrupted it is closed
}

void Draft::replace() {
  sync();
  rename_whole(name_, path_);
  replaced_ = true;
}

std::string new_draft_folder(const std::string& path) {
  std::string name = made_beside(path, [](const char* free) { return ::mkdir(free, 0777); });
  if (name.empty()) throw error_of(path, "cannot be made");
  return name;
}

void rename_whole(const std::string& draft, const std::string& path) {
  if (uninterrupted([&] { return ::rename(draft.c_str(), path.c_str()); }) != 0) throw error_of(path, not_written);
  flush_directory_of(path);
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
  // Nobody may ever write to a pipe that a file was expected to be: neither open() nor read() may wait for it.
  Descriptor file(uninterrupted([&] { return ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC); }));
  if (!file.open()) throw file_error(path, "cannot be opened", errno);
  struct stat status {};
  if (::fstat(file.get(), &status) != 0) throw file_error(path, "cannot be read", errno);
  if (S_ISDIR(status.st_mode)) throw file_error(path, "cannot be read", EISDIR);
  if (!S_ISREG(status.st_mode))
    throw InputError({path, 0, ""}, "is not a regular file",
                     fmt::format("name a file, or {} for standard input", standard_input));
  return file;
}

std::string read_file(const std::string& path) {
  struct stat status {};
  const bool pipe = path == standard_input && ::fstat(STDIN_FILENO, &status) == 0 && !S_ISREG(status.st_mode);
  const Descriptor fd = pipe ? Descriptor(::dup(STDIN_FILENO)) : opened_to_read(path);
  if (!fd.open() || ::fstat(fd.get(), &status) != 0) throw file_error(path, "cannot be read", errno);
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

void Draft::replace_keeping(const std::string& old) {
  sync();
  if (uninterrupted([&] { return ::rename(path_.c_str(), old.c_str()); }) != 0 && errno != ENOENT)
    throw error_of(old, not_written);
  replace();
}

void write_file_atomically(const std::string& path, std::string_view content) {
  Draft draft(path);
  draft.write(content);
  draft.replace();
}

void write_files_together(const std::vector<std::pair<std::string, std::string>>& files) {
  std::list<Draft> drafts;
  for (const auto& [path, content] : files) {
    Draft& draft = drafts.emplace_back(path);
    draft.write(content);
    draft.sync();
  }
  for (Draft& draft : drafts) draft.replace();
}

std::string new_part_of(const std::string& path) {
  Draft draft(path);
  return draft.keep();
}

std::string without_part(const std::string& name) {
  const std::size_t at = name.rfind(part);
  if (at == std::string::npos || at == 0) return "";
  const std::string number = name.substr(at + std::strlen(part));
  return number.find_first_not_of("0123456789-") == std::string::npos ? name.substr(0, at) : "";
}

const char* remedy_for_errno(int code) { return remedy_for(code); }

std::ifstream opened_stream(const std::string& path) {
  refuse_devices(path);
  std::ifstream file(path, std::ios::binary);
  if (!file) throw file_error(path, "cannot be opened", errno);
  return file;
}

void refuse_devices(const std::string& path) { opened_to_read(path); }

void refuse_existing(const std::string& path, const std::string& option, bool force) {
  if (!force && ::access(path.c_str(), F_OK) == 0)
    throw InputError({path, 0, option}, "exists", "choose another name, or give --force to replace it");
}

std::string hash_hex(std::string_view content) {
  return fmt::format("{:016x}", static_cast<std::uint64_t>(XXH64(content.data(), content.size(), 0)));
}

}  // namespace ropewalk
