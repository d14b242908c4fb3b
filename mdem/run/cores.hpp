// If threads are bound to cores (OMP_PROC_BIND, OMP_PLACES), the OpenMP runtime binds the first thread before
// main(). A program started from there would inherit that single core.
#pragma once

namespace ropewalk {

// Makes all cores available again. Call it before exec. A failure costs only speed.
void give_back_cores();

}  // namespace ropewalk
