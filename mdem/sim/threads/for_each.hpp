// The only loops that threads share. One thread works without a team: GCC's OpenMP makes a team of one as well,
// also where an if clause is false, and asks the kernel at each of its barriers to wake nobody. For a small rope
// that takes longer than the step. Each thread of a team has the vector unit of the one that made it.
#pragma once

#include "sim/threads/threads.hpp"
#include "sim/threads/vector_unit.hpp"

namespace ropewalk {

inline bool alone(bool parallel) { return !parallel || threads_in_use() == 1; }

// work() by every thread if `parallel`, else by this one. Loops inside are shared by `omp for`.
template <class Work>
void in_team(bool parallel, const Work& work) {
  if (alone(parallel)) return work();
  const VectorUnit unit = vector_unit_in_use();
#pragma omp parallel
  {
    use_vector_unit(unit);
    work();
  }
}

// work(k) for 0 <= k < n; if `parallel`, each thread takes consecutive k, the same ones in every call.
template <class Index, class Work>
void for_each(Index n, bool parallel, const Work& work) {
  if (n < 2 || alone(parallel)) {
    for (Index k = 0; k < n; ++k) work(k);
    return;
  }
  const VectorUnit unit = vector_unit_in_use();
#pragma omp parallel
  {
    use_vector_unit(unit);
#pragma omp for schedule(static)
    for (Index k = 0; k < n; ++k) work(k);
  }
}

// The same where work(k) takes unequal times: a thread that is done takes the next `grain`.
template <class Index, class Work>
void for_each_uneven(Index n, Index grain, bool parallel, const Work& work) {
  if (n <= grain || alone(parallel)) {
    for (Index k = 0; k < n; ++k) work(k);
    return;
  }
  const VectorUnit unit = vector_unit_in_use();
#pragma omp parallel
  {
    use_vector_unit(unit);
#pragma omp for schedule(dynamic, grain)
    for (Index k = 0; k < n; ++k) work(k);
  }
}

}  // namespace ropewalk
