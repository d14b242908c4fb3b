// Peak performance of the machine with the vectors that the kernels use (use_instructions): the roofline for a
// step.
#pragma once

#include <cstddef>

namespace ropewalk {

struct MachinePeak {
  double arithmetic = 0;  // GFLOP/s: multiply-adds in registers, two operations each
  double transfer = 0;    // GB/s to and from memory, of `triad`
};

// The peak of `threads` threads together, in single or double precision: the best of some short trials. Takes about
// 0.3 s and 400 MB for a short time; throws std::bad_alloc without this memory.
MachinePeak machine_peak(int threads, bool in_double);

// The loops that are timed. multiply_adds() makes `rounds` rounds of  a = a factor + 1/4  in independent chains and
// writes their sum to `out` (64 bytes). It returns the number of operations.
std::size_t multiply_adds(std::size_t rounds, float factor, float* out);
std::size_t multiply_adds(std::size_t rounds, double factor, double* out);
// a = b + 3 c, 24 bytes per entry as STREAM counts them (J. D. McCalpin, 1995). Arrays aligned to 64 bytes, n a
// multiple of 8.
void triad(double* a, const double* b, const double* c, std::size_t n);

}  // namespace ropewalk
