// One target for each reader: it takes any bytes, and either reads them or refuses them with the one type of error
// that a reader throws. Whatever else happens is a fault.
#pragma once

#include <string>
#include <vector>

namespace ropewalk::fuzz {

struct Target {
  const char* name;  // of its folder in corpus/ as well
  void (*read)(const std::string& bytes);
};
const std::vector<Target>& targets();

// A file that holds these bytes, in memory.
class File {
 public:
  explicit File(const std::string& bytes);
  File(const File&) = delete;
  ~File();
  const std::string& path() const { return path_; }

 private:
  int descriptor_;
  std::string path_;
};

// A directory of this process; files in it are written again for every input.
std::string directory();
void write(const std::string& path, const std::string& bytes);

}  // namespace ropewalk::fuzz
