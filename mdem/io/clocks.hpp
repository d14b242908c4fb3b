// Processor time of this process, a clock that never goes back, and times in words.
#pragma once

#include <fmt/format.h>
#include <time.h>

#include <string>

namespace ropewalk {

// s.
inline double seconds_by(clockid_t clock) {
  timespec t{};
  clock_gettime(clock, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

// Sum over all threads, s. Other work on the machine disturbs it less than the wall time.
inline double processor_seconds() { return seconds_by(CLOCK_PROCESS_CPUTIME_ID); }
// The time of a clock that never goes back, s.
inline double steady_seconds() { return seconds_by(CLOCK_MONOTONIC); }
inline double seconds_since(double began) { return steady_seconds() - began; }

// "12 min"
inline std::string duration_text(double s) {
  if (s >= 5400) return fmt::format("{:.1f} h", s / 3600);
  return s >= 90 ? fmt::format("{:.0f} min", s / 60) : fmt::format("{:.0f} s", s);
}

}  // namespace ropewalk
