// Loops that reach the peak of the machine with the vectors that the kernels use (use_instructions).
#pragma once

#include <cstddef>

namespace ropewalk {

// Makes `rounds` rounds of  a = a factor + 1/4  in independent chains and writes their sum to `out` (64 bytes).
// Returns the number of operations, of which a multiply-add is two.
std::size_t multiply_adds(std::size_t rounds, float factor, float* out);
std::size_t multiply_adds(std::size_t rounds, double factor, double* out);
// a = b + 3 c, 24 bytes per entry as STREAM counts them (J. D. McCalpin, 1995). Arrays aligned to 64 bytes, n a
// multiple of 8.
void triad(double* a, const double* b, const double* c, std::size_t n);

}  // namespace ropewalk
