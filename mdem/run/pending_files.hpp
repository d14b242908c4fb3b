// Files of a run that can be written again at any time: manifest, limits, report, state at the end. One that cannot
// be written ends no run: it is said, and tried again.
#pragma once

#include <map>
#include <string>

namespace ropewalk {

class PendingFiles {
 public:
  void write(const std::string& path, std::string content);
  // What could not be written.
  void try_again();
  bool empty() const { return waiting_.empty(); }
  std::string names() const;  // "D/limits.json, D/manifest.json"

 private:
  std::map<std::string, std::string> waiting_;  // content by path
};

}  // namespace ropewalk
