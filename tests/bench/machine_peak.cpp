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

}  // namespace ropewalk
#endif  // VEC_ONCE
