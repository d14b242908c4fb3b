// The number of threads for all that this thread computes from now on.
#pragma once

namespace ropewalk {

// 0: leaves the number unchanged; at first it is that of all cores.
void use_threads(int threads);

}  // namespace ropewalk
