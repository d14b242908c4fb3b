// Processor time of this process.
#pragma once

#include <time.h>

namespace ropewalk {

// Sum over all threads, s. Other work on the machine disturbs it less than the wall time.
inline double processor_seconds() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

}  // namespace ropewalk
