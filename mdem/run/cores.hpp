// Where threads are to be bound to cores (OMP_PROC_BIND, OMP_PLACES), the OpenMP runtime binds the first one before
// main, and a program started from there would have that one core alone.
#pragma once

namespace ropewalk {

// To be called before another program takes this one's place. Where it cannot be done only speed is lost.
void give_back_cores();

}  // namespace ropewalk
