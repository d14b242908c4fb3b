// Runs another program under watch: the one place that does (tests/structure/doors.py). It is ended when this
// process ends, when it writes nothing for too long or too much, and when its time is up.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace ropewalk {

struct ChildOptions {
  std::string folder = ".";          // working directory
  std::string output;                // file for stdout and stderr, absolute or in the folder; empty: those of here
  std::vector<std::string> watched;  // files whose growth is a sign of life, beside the output
  double quiet_seconds = 120, max_seconds = 3600;
  long long most_bytes = 256LL << 20;  // limit for a file that it writes, and for output and watched files together
  std::function<bool()> interrupted;   // may be empty
};

struct ChildEnd {
  enum class Kind { exited, killed_by_signal, quiet, too_long, too_much, interrupted, not_started };
  Kind kind = Kind::not_started;
  int code = 0;  // exit status, signal, or errno of a program that did not start
  double seconds = 0;
};

// Runs arguments[0], searched for in PATH, with one OpenMP thread. The child has its own process group, which is
// ended as a whole. SIGINT and SIGTERM end the child first and then have their usual effect on this process.
ChildEnd run_child(const std::vector<std::string>& arguments, const ChildOptions& options);

// A converter, whose files may be of any size: by its end alone. It may be quiet for as long as it takes.
enum class ProgramEnd { missing, failed, well };
ProgramEnd run_program(const std::vector<std::string>& words);

}  // namespace ropewalk
