// A file that grows while a run goes on: log and frames. A checkpoint marks how far it had come, so that a resumed
// run finds out whether all of that has reached the disk, and cuts off the rest.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "io/descriptor.hpp"

namespace ropewalk {

struct FileMark {
  std::uint64_t bytes = 0;
  std::uint64_t tail_from = 0;
  std::string tail;        // hash of the bytes from there on, hex
  std::int64_t step = -1;  // step of the last row or frame; -1: not known
};

// The mark of a file with this content, or of the first bytes of a file.
FileMark mark_of(std::string_view content);
FileMark mark_of(const std::string& path, std::uint64_t bytes, std::uint64_t tail_begin = 0);

// Whether the file holds what it held at the mark, and perhaps more.
bool reaches(const std::string& path, const FileMark& mark);

// Throws InputError where the disk is full, the file cannot be written, ...
class GrowingFile {
 public:
  // Makes the file, or cuts it back to `keep` bytes.
  GrowingFile(std::string path, std::uint64_t keep);

  void write(std::string_view text);
  // Replaces bytes before the end. Marks must not take them in: see tail_begins_at().
  void patch(std::uint64_t at, std::string_view bytes);
  // Drops all that was written after this mark.
  void cut(std::uint64_t keep);
  // Has all of it on the disk.
  void sync();
  FileMark mark() const;
  std::uint64_t size() const { return size_; }
  // Marks are made of the bytes from here on.
  void tail_begins_at(std::uint64_t begin) { tail_begin_ = begin; }

 private:
  [[noreturn]] void fail() const;

  std::string path_;
  Descriptor file_;
  std::uint64_t size_ = 0, tail_begin_ = 0;
  std::string tail_;  // the last bytes, as many as a mark needs or more
};

}  // namespace ropewalk
