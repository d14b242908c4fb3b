// A file that grows while a run goes on: log and frames. A checkpoint marks how far it had come, so that a resumed
// run finds out whether all of that has reached the disk, and cuts off what was written afterwards.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "io/descriptor.hpp"

namespace ropewalk {

struct FileMark {
  std::uint64_t bytes = 0;
  std::string tail;  // hash of the last bytes before it, hex
};

// Of a file with this content; of the first bytes of a file.
FileMark mark_of(std::string_view content);
FileMark mark_of(const std::string& path, std::uint64_t bytes);

// Whether the file holds what it held at the mark, and perhaps more.
bool reaches(const std::string& path, const FileMark& mark);

// Throws InputError where the disk is full, the file cannot be written, ...
class GrowingFile {
 public:
  // Makes the file, or cuts it back to so many bytes.
  GrowingFile(std::string path, std::uint64_t keep);

  void write(std::string_view text);
  // What was written after this did not happen.
  void cut(std::uint64_t keep);
  // Has all of it on the disk.
  void sync();
  FileMark mark() const;

 private:
  [[noreturn]] void fail() const;

  std::string path_;
  Descriptor file_;
  std::uint64_t size_ = 0;
  std::string tail_;
};

}  // namespace ropewalk
