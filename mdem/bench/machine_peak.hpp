// What the machine can do at most, with the vectors that the kernels take (use_instructions): the roofline that a
// step is held to.
#pragma once

#include <cstddef>

namespace ropewalk {

struct MachinePeak {
  double arithmetic = 0;  // GFLOP/s: multiply-adds in registers, two operations each
  double transfer = 0;    // GB/s to and from memory, of `triad`
};

// Of so many threads at once, in single precision or in double: the best of some short trials. Takes some 0.3 s
// and, for a while, 400 MB; throws std::bad_alloc without them.
MachinePeak machine_peak(int threads, bool in_double);

// Its loops. So many rounds a = a factor + 1/4 in independent chains, of which `out`, with room for 64 bytes, gets
// the sum. Returns the operations.
std::size_t multiply_adds(std::size_t rounds, float factor, float* out);
std::size_t multiply_adds(std::size_t rounds, double factor, double* out);
// a = b + 3 c, 24 bytes per entry as STREAM counts them (J. D. McCalpin, 1995). Arrays aligned to 64 bytes, n a
// multiple of 8.
void triad(double* a, const double* b, const double* c, std::size_t n);

}  // namespace ropewalk
