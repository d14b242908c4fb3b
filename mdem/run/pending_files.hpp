// Files of a run that can be written again at any time: manifest, limits, report, state at the end. One that cannot
// be written ends no run: it is said, and tried again.
#pragma once

#include <functional>
#include <map>
#include <string>

#include "run/run_directory.hpp"
#include "run/run_listener.hpp"

namespace ropewalk {

class PendingFiles {
 public:
  explicit PendingFiles(RunListener& listener) : listener_(listener) {}

  void write(const std::string& path, std::string content);
  // Tries again to write the files that could not be written.
  void try_again();
  std::string names() const;  // "D/limits.json, D/manifest.json"

 private:
  RunListener& listener_;
  std::map<std::string, std::string> waiting_;  // content by path
};

// Makes a report by `write`. One that cannot be drawn or written is said, since it can be made later.
void report_or_tell(const RunDirectory& dir, RunListener& listener, const std::function<void()>& write);

}  // namespace ropewalk
