// Threads of what this thread computes from now on.
#pragma once

namespace ropewalk {

// 0: leaves the number as it is, at first that of all cores.
void use_threads(int threads);

}  // namespace ropewalk
