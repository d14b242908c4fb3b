// Directories that this program makes and removes. Nothing else in the sources removes a directory with its
// content.
#pragma once

#include <functional>
#include <string>

namespace ropewalk {

// A directory under a name that was free and that nobody can guess, open to this user alone. The process that made
// it removes it at the end, with whatever is in it.
class TemporaryFolder {
 public:
  // Throws InputError where it cannot be made. `in`: the directory that it stands in; empty: that of TMPDIR.
  explicit TemporaryFolder(const std::string& in = "");
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder();

  const std::string& path() const { return path_; }
  std::string file(const std::string& name) const { return path_ + "/" + name; }
  void keep() { process_ = -1; }  // it is not removed

 private:
  std::string path_;
  int process_;
};

// Whether this program made what stands at this place inside a directory: "log.csv", "errors/EA-plus/log.csv".
using IsOurs = std::function<bool(const std::string& inside)>;

// Throws InputError, which names it, where a directory holds anything that is not `ours`. `what`: "of a run".
// `option`: of the command line, for the message. No directory: nothing happens.
void refuse_foreign(const std::string& directory, const IsOurs& ours, const char* what, const char* option);
// Removes what is in the directory, apart from what is to `keep`; links, and not what they name. Removes nothing
// where refuse_foreign() throws.
void remove_inside(const std::string& directory, const IsOurs& ours, const char* what, const char* option,
                   const IsOurs& keep = nullptr);

// Makes an empty directory for a program whose files this one does not know by name, such as LAMMPS, and marks it
// by a file. One that is there already is made empty if it has that file; InputError where it has not and is not
// empty.
void make_work_folder(const std::string& path, const char* option);
// Removes a directory that make_work_folder() made.
void remove_work_folder(const std::string& path);

}  // namespace ropewalk
