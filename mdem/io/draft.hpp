// Files and directories that stand beside those of the user until they are whole. Nothing else in the sources
// renames one, or makes one under a name made from another's (tests/structure/doors.py).
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include "io/descriptor.hpp"
#include "model/error.hpp"

namespace ropewalk {

// As file_error() of io/files.hpp.
class FileError : public InputError {
 public:
  FileError(const InputError& said, int code) : InputError(said), code_(code) {}
  int code() const { return code_; }  // errno

 private:
  int code_;
};

// A file beside `path` under a name that was free, which becomes `path` once it is whole. The destructor removes
// one that has not. Its members throw FileError, which names `path`.
class Draft {
 public:
  // Makes it, empty.
  explicit Draft(std::string path);
  Draft(const Draft&) = delete;
  Draft& operator=(const Draft&) = delete;
  ~Draft();

  const std::string& name() const { return name_; }
  void write(std::string_view content);
  // Replaces bytes that were written.
  void patch(std::uint64_t at, std::string_view bytes);
  // For a program that has failed to write it, and tells no reason: throws where the system takes no more of it.
  void need_room() const;
  // Has all of it on the disk.
  void sync();
  void replace();
  // The same; the file that was there before takes the name `old`. Between the two renames it alone is there.
  void replace_keeping(const std::string& old);
  // Its name; it is not removed.
  std::string keep() {
    replaced_ = true;
    return name_;
  }

 private:
  void take_permissions();  // the old file's permissions; other programs cannot write a read-only draft

  std::string path_, name_;
  Descriptor file_;
  bool replaced_ = false;
};

// Makes a draft directory. The caller removes it; without_part() of io/files.hpp recognises one of a killed
// process.
std::string new_draft_folder(const std::string& path);
// Renames a whole file or directory to the name that it was made for.
void rename_whole(const std::string& draft, const std::string& path);

}  // namespace ropewalk
