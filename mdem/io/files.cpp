#include "io/files.hpp"

#define XXH_INLINE_ALL
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>
#include <xxhash.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>

#include "model/error.hpp"

namespace ropewalk {
namespace {

[[noreturn]] void cannot(const char* what, const std::string& path) {
  throw InputError({path, 0, ""}, fmt::format("cannot be {}: {}", what, std::strerror(errno)),
                   "check the path, its permissions and the free space");
}

void write_all(int file, std::string_view content, const std::string& temporary, const std::string& path) {
  while (!content.empty()) {
    const ssize_t done = ::write(file, content.data(), content.size());
    if (done < 0) {
      if (errno == EINTR) continue;
      const int why = errno;
      ::close(file);
      ::unlink(temporary.c_str());
      errno = why;
      cannot("written", path);
    }
    content.remove_prefix(static_cast<std::size_t>(done));
  }
}

}  // namespace

std::string read_file(const std::string& path) {
  struct stat info {};
  if (::stat(path.c_str(), &info) != 0) cannot("read", path);
  if (S_ISDIR(info.st_mode)) throw InputError({path, 0, ""}, "is a directory", "name a file");
  std::ifstream in(path, std::ios::binary);
  if (!in) cannot("read", path);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

void write_file_atomically(const std::string& path, std::string_view content) {
  std::string temporary = path + ".XXXXXX";
  const int file = ::mkstemp(temporary.data());
  if (file < 0) cannot("written", path);
  write_all(file, content, temporary, path);
  ::fchmod(file, 0644);
  const bool safe = ::fsync(file) == 0;
  const bool closed = ::close(file) == 0;
  if (!safe || !closed || ::rename(temporary.c_str(), path.c_str()) != 0) {
    const int why = errno;
    ::unlink(temporary.c_str());
    errno = why;
    cannot("written", path);
  }
}

std::string hash_hex(std::string_view content) {
  return fmt::format("{:016x}", XXH64(content.data(), content.size(), 0));
}

}  // namespace ropewalk
