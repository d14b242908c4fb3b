// The number of threads for all that this thread computes. Nothing else in the sources asks OpenMP for it or sets
// it (tests/structure/doors.py).
#pragma once

#include <omp.h>

#include <algorithm>

namespace ropewalk {

// GCC's OpenMP keeps what it knows of a team on the stack: 100 000 threads end the process without a word.
inline constexpr int most_threads = 1024;

// At first that of all cores, or that of OMP_NUM_THREADS; never more than most_threads.
inline int threads_in_use() {
  const int threads = omp_get_max_threads();
  if (threads > most_threads) omp_set_num_threads(most_threads);
  return std::min(threads, most_threads);
}

// Sets the number from now on; 0 leaves it unchanged.
inline void use_threads(int threads) {
  if (threads > 0) omp_set_num_threads(std::min(threads, most_threads));
}

}  // namespace ropewalk
