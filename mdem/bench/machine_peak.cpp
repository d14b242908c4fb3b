#include "bench/machine_peak.hpp"

#undef VEC_SOURCE
#define VEC_SOURCE "bench/machine_peak.cpp"
#include "sim/vectors/each_set-inl.hpp"
//
#include "sim/vectors/operations-inl.hpp"

VEC_BEFORE_NAMESPACE();
namespace ropewalk::VEC_SET {
namespace ops = vec::VEC_SET;

// Number of independent chains: more than latency times throughput of any unit in use, and few enough for 16
// registers.
constexpr int chains = 12;

template <class T, int cap>
VEC_INLINE std::size_t in_chains(std::size_t rounds, T by, T* out) {
  const ops::CappedTag<T, cap> d;
  const auto factor = ops::Set(d, by), term = ops::Set(d, static_cast<T>(0.25));
  ops::Vec<decltype(d)> a[chains];
  for (int k = 0; k < chains; ++k) a[k] = ops::Set(d, static_cast<T>(k));
  for (std::size_t r = 0; r < rounds; ++r)
    for (int k = 0; k < chains; ++k) a[k] = ops::MulAdd(a[k], factor, term);
  for (int k = 1; k < chains; ++k) a[0] = ops::Add(a[0], a[k]);
  ops::Store(a[0], d, out);
  return rounds * chains * 2 * ops::Lanes(d);
}

std::size_t PeakOfFloats(std::size_t rounds, float factor, float* out) {
  return in_chains<float, 16>(rounds, factor, out);
}
std::size_t PeakOfDoubles(std::size_t rounds, double factor, double* out) {
  return in_chains<double, 8>(rounds, factor, out);
}

void Triad(double* __restrict a, const double* __restrict b, const double* __restrict c, std::size_t n) {
  const ops::CappedTag<double, 8> d;
  const auto three = ops::Set(d, 3.0);
  for (std::size_t i = 0; i < n; i += ops::Lanes(d))
    ops::Store(ops::MulAdd(ops::Load(d, c + i), three, ops::Load(d, b + i)), d, a + i);
}

}  // namespace ropewalk::VEC_SET
VEC_AFTER_NAMESPACE();

#if VEC_ONCE
#include <omp.h>

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <new>

namespace ropewalk {

VEC_EXPORT(PeakOfFloats);
VEC_EXPORT(PeakOfDoubles);
VEC_EXPORT(Triad);

std::size_t multiply_adds(std::size_t rounds, float factor, float* out) {
  return VEC_IN_USE(PeakOfFloats)(rounds, factor, out);
}
std::size_t multiply_adds(std::size_t rounds, double factor, double* out) {
  return VEC_IN_USE(PeakOfDoubles)(rounds, factor, out);
}
void triad(double* a, const double* b, const double* c, std::size_t n) { VEC_IN_USE(Triad)(a, b, c, n); }

namespace {

// The best rate (per ns) of some trials. `work` returns the number of its operations or bytes.
template <class Work>
double best_rate(int trials, const Work& work) {
  double best = 0;
  for (int k = 0; k < trials; ++k) {
    const double began = omp_get_wtime(), done = work();
    best = std::max(best, done / (omp_get_wtime() - began));
  }
  return 1e-9 * best;
}

template <class T>
double arithmetic_peak(int threads) {
  constexpr std::size_t rounds = 500000;  // takes some ms
  const VectorUnit unit = vector_unit_in_use();
  return best_rate(6, [&] {
    double operations = 0;
#pragma omp parallel num_threads(threads) reduction(+ : operations)
    {
      use_vector_unit(unit);
      T out[64 / sizeof(T)];
      const auto done = static_cast<double>(multiply_adds(rounds, T{0.5}, out));
      operations += out[0] > 0 ? done : 0.0;  // uses the result, so that the compiler keeps the operations
    }
    return operations;
  });
}

double transfer_peak(int threads) {
  // 128 MiB in each array, more than the caches hold, in as many pieces for each thread.
  const std::ptrdiff_t pieces = 64 * threads, piece = (std::ptrdiff_t{1} << 24) / pieces / 8 * 8;
  const auto array = [&] {
    return std::unique_ptr<double[], decltype(&std::free)>(
        static_cast<double*>(std::aligned_alloc(64, static_cast<std::size_t>(pieces * piece) * sizeof(double))),
        &std::free);
  };
  const auto a = array(), b = array(), c = array();
  if (!a || !b || !c) throw std::bad_alloc();
  const VectorUnit unit = vector_unit_in_use();
  // Memory is placed near the thread that writes to it first.
#pragma omp parallel for schedule(static) num_threads(threads)
  for (std::ptrdiff_t i = 0; i < pieces * piece; ++i) a[i] = 1, b[i] = 2, c[i] = 3;
  return best_rate(4, [&] {
#pragma omp parallel for schedule(static) num_threads(threads)
    for (std::ptrdiff_t k = 0; k < pieces; ++k) {
      use_vector_unit(unit);
      triad(a.get() + k * piece, b.get() + k * piece, c.get() + k * piece, static_cast<std::size_t>(piece));
    }
    return 24.0 * static_cast<double>(pieces * piece);
  });
}

}  // namespace

MachinePeak machine_peak(int threads, bool in_double) {
  return {in_double ? arithmetic_peak<double>(threads) : arithmetic_peak<float>(threads), transfer_peak(threads)};
}

}  // namespace ropewalk
#endif  // VEC_ONCE
