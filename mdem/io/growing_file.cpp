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

std::uint64_t tail_from(std::uint64_t end, std::uint64_t begin) {
  return std::min(end, std::max(begin, end - std::min(end, tail_bytes)));
}

// Fewer where the file is shorter or cannot be read.
std::string bytes_between(int fd, std::uint64_t from, std::uint64_t end) {
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

FileMark mark_of(std::string_view content) {
  return {content.size(), tail_from(content.size(), 0), hash_hex(tail_of(content))};
}

FileMark mark_of(const std::string& path, std::uint64_t bytes, std::uint64_t tail_begin) {
  const std::uint64_t from = tail_from(bytes, tail_begin);
  return {bytes, from, hash_hex(bytes_between(opened_to_read(path).get(), from, bytes))};
}

bool reaches(const std::string& path, const FileMark& mark) {
  if (::access(path.c_str(), F_OK) != 0 || mark.tail_from > mark.bytes) return false;
  struct stat status;
  const Descriptor file = opened_to_read(path);
  if (::fstat(file.get(), &status) != 0 || static_cast<std::uint64_t>(status.st_size) < mark.bytes) return false;
  return hash_hex(bytes_between(file.get(), mark.tail_from, mark.bytes)) == mark.tail;
}

GrowingFile::GrowingFile(std::string path, std::uint64_t keep)
    : path_(std::move(path)), file_(opened_to_write(path_, O_RDWR)) {
  cut(keep);
}

void GrowingFile::write(std::string_view text) {
  if (!write_all_at(file_.get(), text, size_)) {
    const int code = errno;
    cut(size_);  // no part of a line stays behind
    errno = code;
    fail();
  }
  size_ += text.size();
  tail_ += tail_of(text);
  if (tail_.size() > 2 * tail_bytes) tail_.erase(0, tail_.size() - tail_bytes);
}

void GrowingFile::patch(std::uint64_t at, std::string_view bytes) {
  if (!write_all_at(file_.get(), bytes, at)) fail();
}

void GrowingFile::cut(std::uint64_t keep) {
  // A driver of FAT refuses to cut a file to the length that it has.
  struct stat status;
  const bool is_so_long = ::fstat(file_.get(), &status) == 0 && static_cast<std::uint64_t>(status.st_size) == keep;
  if (!is_so_long && uninterrupted([&] { return ::ftruncate(file_.get(), static_cast<off_t>(keep)); }) != 0) fail();
  size_ = keep;
  tail_ = bytes_between(file_.get(), tail_from(keep, 0), keep);
}

void GrowingFile::sync() {
  if (!flush_to_disk(file_.get())) fail();
}

FileMark GrowingFile::mark() const {
  const std::uint64_t from = tail_from(size_, tail_begin_);
  return {size_, from, hash_hex(std::string_view(tail_).substr(tail_.size() - (size_ - from)))};
}

void GrowingFile::fail() const {
  throw InputError({path_, 0, ""}, fmt::format("cannot be written: {}", std::strerror(errno)),
                   remedy_for_errno(errno));
}

}  // namespace ropewalk
