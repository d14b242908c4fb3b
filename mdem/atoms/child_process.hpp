// Runs a program under watch. It is ended when this process ends, when it writes nothing for too long, and when its
// time is up.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace ropewalk {

struct ChildOptions {
  std::string folder;                // working directory
  std::string output;                // file for stdout and stderr, absolute or in the folder
  std::vector<std::string> watched;  // files whose growth is a sign of life, beside the output
  double quiet_seconds = 120, max_seconds = 3600;
  std::function<bool()> interrupted;  // may be empty
};

struct ChildEnd {
  enum class Kind { exited, killed_by_signal, quiet, too_long, interrupted, not_started };
  Kind kind = Kind::not_started;
  int code = 0;  // exit status, signal, or errno of a program that did not start
  double seconds = 0;
};

// Runs arguments[0], searched for in PATH, with one OpenMP thread. The child has its own process group, which is
// ended as a whole. SIGINT and SIGTERM end the child first and then have their usual effect on this process.
ChildEnd run_child(const std::vector<std::string>& arguments, const ChildOptions& options);

}  // namespace ropewalk
