// The memory that a scene needs, before it is taken.
#pragma once

#include <string>

namespace ropewalk {

// Bytes of a run of `elements` elements at its largest, which is where it writes its report. Ropes of 200 000
// elements take 2.2 kB each by either contact law, and 2.7 kB with the widest margin of the neighbour list.
inline double memory_needed(double elements) { return 2500.0 * elements; }

// Bytes that this process may take: of the machine, or less where a limit is set on it.
double memory_allowed();

// "about 50 GB of memory, and 25 GB may be used here"; empty where the elements fit.
std::string beyond_memory(double elements);

}  // namespace ropewalk
