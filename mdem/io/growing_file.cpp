#include "io/growing_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "io/files.hpp"

namespace ropewalk {
namespace {

constexpr std::uint64_t tail_bytes = 1 << 16;

std::string_view tail_of(std::string_view content) {
  return content.substr(content.size() - std::min<std::size_t>(content.size(), tail_bytes));
}

// The last bytes before `end`; fewer where the file is shorter or cannot be read.
std::string tail_before(int fd, std::uint64_t end) {
  const std::uint64_t from = end - std::min(end, tail_bytes);
  std::string text(end - from, '\0');
  std::size_t have = 0;
  while (have < text.size()) {
    const ssize_t n = uninterrupted(
        [&] { return ::pread(fd, text.data() + have, text.size() - have, static_cast<off_t>(from + have)); });
    if (n <= 0) break;
    have += static_cast<std::size_t>(n);
  }
  text.resize(have);
  return text;
}

}  // namespace

FileMark mark_of(std::string_view content) { return {content.size(), hash_hex(tail_of(content))}; }

FileMark mark_of(const std::string& path, std::uint64_t bytes) {
  const Descriptor file(uninterrupted([&] { return ::open(path.c_str(), O_RDONLY | O_CLOEXEC); }));
  if (!file.open()) throw file_error(path, "cannot be opened", errno);
  return {bytes, hash_hex(tail_before(file.get(), bytes))};
}

bool reaches(const std::string& path, const FileMark& mark) {
  return ::access(path.c_str(), F_OK) == 0 && mark_of(path, mark.bytes).tail == mark.tail;
}

GrowingFile::GrowingFile(std::string path, std::uint64_t keep)
    : path_(std::move(path)),
      file_(uninterrupted([&] { return ::open(path_.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0666); })) {
  if (!file_.open()) fail();
  cut(keep);
}

void GrowingFile::write(std::string_view text) {
  if (!write_all(file_.get(), text)) {
    const int code = errno;
    cut(size_);  // no part of a line stays behind
    errno = code;
    fail();
  }
  size_ += text.size();
  tail_ += tail_of(text);
  if (tail_.size() > 2 * tail_bytes) tail_.erase(0, tail_.size() - tail_bytes);
}

void GrowingFile::cut(std::uint64_t keep) {
  if (uninterrupted([&] { return ::ftruncate(file_.get(), static_cast<off_t>(keep)); }) != 0) fail();
  size_ = keep;
  tail_ = tail_before(file_.get(), keep);
}

void GrowingFile::sync() {
  if (uninterrupted([&] { return ::fdatasync(file_.get()); }) != 0) fail();
}

FileMark GrowingFile::mark() const { return {size_, hash_hex(tail_of(tail_))}; }

void GrowingFile::fail() const {
  throw InputError({path_, 0, ""}, fmt::format("cannot be written: {}", std::strerror(errno)),
                   fmt::format("{}; the last checkpoint stands", remedy_for_errno(errno)));
}

}  // namespace ropewalk
