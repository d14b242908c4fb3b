#include "run/threads.hpp"

#include <omp.h>

namespace ropewalk {

void use_threads(int threads) {
  if (threads > 0) omp_set_num_threads(threads);
}

}  // namespace ropewalk
