#include "run/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>

namespace ropewalk {
namespace {

double seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

std::string clock(double s) {
  const long t = static_cast<long>(s + 0.5);
  if (t >= 3600) return fmt::format("{}:{:02d}:{:02d}", t / 3600, t / 60 % 60, t % 60);
  return fmt::format("{}:{:02d}", t / 60, t % 60);
}

}  // namespace

Progress::Progress(bool quiet, double done, double total)
    : quiet_(quiet), terminal_(isatty(STDERR_FILENO) != 0), first_(done), total_(total), started_(seconds()) {}

bool Progress::due() {
  if (quiet_ || ++calls_ % 8 != 0) return false;
  const double t = seconds();
  if (t < next_) return false;
  next_ = t + (terminal_ ? 0.5 : 10.0);
  return true;
}

void Progress::show(double done, const std::string& status) {
  const double elapsed = seconds() - started_;
  std::string line;
  if (total_ > 0) {
    const double part = done / total_;
    const double left = done > first_ ? elapsed * (total_ - done) / (done - first_) : 0.0;
    line = fmt::format("{:5.1f} %  {} left  {}", 100 * part, clock(left), status);
  } else {
    line = fmt::format("step {:.0f}  {}", done, status);
  }
  fmt::print(stderr, terminal_ ? "\r{}\033[K" : "{}\n", line);
  std::fflush(stderr);
  shown_ = true;
}

void Progress::done() {
  if (shown_ && terminal_) fmt::print(stderr, "\n");
}

}  // namespace ropewalk
