// The only loops that threads share. One thread works without a team: GCC's OpenMP makes a team of one as well,
// also where an if clause is false, and asks the kernel at each of its barriers to wake nobody. For a small rope
// that takes longer than the step.
#pragma once

#include <omp.h>

namespace ropewalk {

inline bool alone(bool parallel) { return !parallel || omp_get_max_threads() == 1; }

// work() by every thread if `parallel`, else by this one. Loops inside are shared by `omp for`.
template <class Work>
void in_team(bool parallel, const Work& work) {
  if (alone(parallel)) return work();
#pragma omp parallel
  work();
}

// work(k) for 0 <= k < n; if `parallel`, each thread takes consecutive k, the same ones in every call.
template <class Index, class Work>
void for_each(Index n, bool parallel, const Work& work) {
  if (n < 2 || alone(parallel)) {
    for (Index k = 0; k < n; ++k) work(k);
    return;
  }
#pragma omp parallel for schedule(static)
  for (Index k = 0; k < n; ++k) work(k);
}

// The same where work(k) takes unequal times: a thread that is done takes the next `grain`.
template <class Index, class Work>
void for_each_uneven(Index n, Index grain, bool parallel, const Work& work) {
  if (n <= grain || alone(parallel)) {
    for (Index k = 0; k < n; ++k) work(k);
    return;
  }
#pragma omp parallel for schedule(dynamic, grain)
  for (Index k = 0; k < n; ++k) work(k);
}

}  // namespace ropewalk
