#include "run/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include "run/tell.hpp"
#include "run/wall_time.hpp"

namespace ropewalk {
namespace {

std::string clock(double s) {
  const long t = static_cast<long>(s + 0.5);
  if (t >= 3600) return fmt::format("{}:{:02d}:{:02d}", t / 3600, t / 60 % 60, t % 60);
  return fmt::format("{}:{:02d}", t / 60, t % 60);
}

}  // namespace

Progress::Progress(bool quiet, double done, double total)
    : quiet_(quiet),
      terminal_(isatty(STDERR_FILENO) != 0),
      first_(done),
      total_(total),
      started_(steady_seconds()) {}

bool Progress::due() {
  if (quiet_ || ++calls_ % 8 != 0) return false;
  const double t = steady_seconds();
  if (t < next_) return false;
  next_ = t + (terminal_ ? 0.5 : 10.0);
  return true;
}

void Progress::show(double done, const std::string& status) {
  const double elapsed = steady_seconds() - started_;
  std::string line;
  if (total_ > 0) {
    const double part = done / total_;
    const std::string left = done > first_ ? clock(elapsed * (total_ - done) / (done - first_)) + " left" : "";
    line = fmt::format("{:5.1f} %  {}  {}", 100 * part, left, status);
  } else {
    line = fmt::format("step {:.0f}  {}", done, status);
  }
  tell_as_is(terminal_ ? "\r" + line + "\033[K" : line + "\n");
  shown_ = true;
}

void Progress::done() {
  if (shown_ && terminal_) tell_as_is("\n");
}

}  // namespace ropewalk
