#include "sim/vectors/base.hpp"

#ifndef VEC_ONCE
#define VEC_ONCE (VEC_TARGET == VEC_BASE)

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <utility>
#if defined(__x86_64__)
#include <immintrin.h>
#endif

#ifdef VEC_HAS_AVX2
#define VEC_IN_V3(F) &in_v3::F
#else
#define VEC_IN_V3(F) &in_base::F
#endif
#ifdef VEC_HAS_AVX512
#define VEC_IN_V4(F) &in_v4::F
#else
#define VEC_IN_V4(F) VEC_IN_V3(F)
#endif
// Instances in the order of VectorUnit.
#define VEC_EXPORT(F) static decltype(&in_base::F) const F##_of_units[] = {&in_base::F, VEC_IN_V3(F), VEC_IN_V4(F)}
#define VEC_IN_USE(F) (*F##_of_units[static_cast<int>(vector_unit_in_use())])

namespace ropewalk::vec {

template <std::size_t bytes>
struct IntegerOf;
template <>
struct IntegerOf<4> {
  using Signed = std::int32_t;
  using Unsigned = std::uint32_t;
};
template <>
struct IntegerOf<8> {
  using Signed = std::int64_t;
  using Unsigned = std::uint64_t;
};

// The place of the lowest bit of a number that is not zero.
inline std::size_t first_bit(std::uint64_t bits) { return static_cast<std::size_t>(__builtin_ctzll(bits)); }

}  // namespace ropewalk::vec
#endif  // VEC_ONCE

#if defined(VEC_OPERATIONS_PER_SET) == defined(VEC_TOGGLE)
#ifdef VEC_OPERATIONS_PER_SET
#undef VEC_OPERATIONS_PER_SET
#else
#define VEC_OPERATIONS_PER_SET
#endif

#undef VEC_SET
#undef VEC_ATTR
#undef VEC_BEFORE_NAMESPACE
#undef VEC_AFTER_NAMESPACE
#undef VEC_BYTES
#if VEC_TARGET == VEC_AVX512
#define VEC_SET in_v4
#define VEC_BYTES 64
#define VEC_ATTR __attribute__((target("avx2,fma,bmi,bmi2,avx512f,avx512bw,avx512dq,avx512vl")))
#define VEC_BEFORE_NAMESPACE() \
  _Pragma("GCC push_options")  \
      _Pragma("GCC target(\"avx2,fma,bmi,bmi2,avx512f,avx512bw,avx512dq,avx512vl\")") static_assert(true, "")
#define VEC_AFTER_NAMESPACE() _Pragma("GCC pop_options") static_assert(true, "")
#elif VEC_TARGET == VEC_AVX2
#define VEC_SET in_v3
#define VEC_BYTES 32
#define VEC_ATTR __attribute__((target("avx2,fma,bmi,bmi2")))
#define VEC_BEFORE_NAMESPACE() \
  _Pragma("GCC push_options") _Pragma("GCC target(\"avx2,fma,bmi,bmi2\")") static_assert(true, "")
#define VEC_AFTER_NAMESPACE() _Pragma("GCC pop_options") static_assert(true, "")
#else
#define VEC_SET in_base
#define VEC_BYTES 16
#define VEC_ATTR
#define VEC_BEFORE_NAMESPACE() static_assert(true, "")
#define VEC_AFTER_NAMESPACE() static_assert(true, "")
#endif

VEC_BEFORE_NAMESPACE();
namespace ropewalk::vec {
namespace VEC_SET {

// --- types ----------------------------------------------------------------------------------------------

template <class T_, std::size_t N>
struct Simd {
  using T = T_;
  static constexpr std::size_t lanes = N;
};
template <class T, std::size_t most>
using CappedTag = Simd<T, std::min(most, VEC_BYTES / sizeof(T))>;
template <class T>
using ScalableTag = Simd<T, VEC_BYTES / sizeof(T)>;
template <class D>
using TFromD = typename D::T;
template <class T, class D>
using Rebind = Simd<T, D::lanes>;
template <class D>
using RebindToSigned = Simd<typename IntegerOf<sizeof(TFromD<D>)>::Signed, D::lanes>;
template <class D>
using RebindToUnsigned = Simd<typename IntegerOf<sizeof(TFromD<D>)>::Unsigned, D::lanes>;
template <class D>
struct VectorOf {
  using T = TFromD<D>;
  typedef T Lanes __attribute__((vector_size(sizeof(T) * D::lanes)));
  typedef typename IntegerOf<sizeof(T)>::Signed Bits __attribute__((vector_size(sizeof(T) * D::lanes)));
  // Numbers of type T in memory. A store changes nothing else, so that pointers and counts stay in registers.
  typedef T InMemory __attribute__((vector_size(sizeof(T) * D::lanes), aligned(alignof(T))));
  using Tag = D;
  Lanes raw;

  VEC_INLINE Bits bits() const { return reinterpret_cast<Bits>(raw); }
  static VEC_INLINE VectorOf of_bits(Bits v) { return {reinterpret_cast<Lanes>(v)}; }
};
template <class D>
using Vec = VectorOf<std::remove_cv_t<D>>;
template <class V>
using DFromV = typename V::Tag;

// A bit for each lane with AVX-512, else all bits of the lane.
template <class D>
struct MaskOf {
#if VEC_TARGET == VEC_AVX512
  using Raw = std::conditional_t<(D::lanes > 8), std::uint16_t, std::uint8_t>;
#else
  using Raw = typename VectorOf<D>::Bits;
#endif
  Raw raw;
};
template <class D>
using Mask = MaskOf<std::remove_cv_t<D>>;

template <class D>
VEC_INLINE constexpr std::size_t Lanes(D) {
  return D::lanes;
}
// --- memory ---------------------------------------------------------------------------------------------

template <class D>
VEC_INLINE Vec<D> Load(D, const TFromD<D>* p) {
  return {*reinterpret_cast<const typename Vec<D>::InMemory*>(p)};
}
template <class D>
VEC_INLINE void Store(Vec<D> v, D, TFromD<D>* p) {
  *reinterpret_cast<typename Vec<D>::InMemory*>(p) = v.raw;
}
// --- arithmetic -----------------------------------------------------------------------------------------

template <class D>
VEC_INLINE Vec<D> Zero(D) {
  return {typename Vec<D>::Lanes{}};
}
template <class D>
VEC_INLINE Vec<D> Set(D, TFromD<D> x) {
  return {x - typename Vec<D>::Lanes{}};
}
template <class D>
VEC_INLINE VectorOf<D> Add(VectorOf<D> a, VectorOf<D> b) {
  return {a.raw + b.raw};
}
template <class D>
VEC_INLINE VectorOf<D> Sub(VectorOf<D> a, VectorOf<D> b) {
  return {a.raw - b.raw};
}
template <class D>
VEC_INLINE VectorOf<D> Mul(VectorOf<D> a, VectorOf<D> b) {
  return {a.raw * b.raw};
}
template <class D>
VEC_INLINE VectorOf<D> Div(VectorOf<D> a, VectorOf<D> b) {
  return {a.raw / b.raw};
}
// The compiler makes one instruction of these where the machine has it.
template <class D>
VEC_INLINE VectorOf<D> MulAdd(VectorOf<D> a, VectorOf<D> b, VectorOf<D> c) {
  return {a.raw * b.raw + c.raw};
}
template <class D>
VEC_INLINE VectorOf<D> MulSub(VectorOf<D> a, VectorOf<D> b, VectorOf<D> c) {
  return {a.raw * b.raw - c.raw};
}
template <class D>
VEC_INLINE VectorOf<D> NegMulAdd(VectorOf<D> a, VectorOf<D> b, VectorOf<D> c) {
  return {c.raw - a.raw * b.raw};
}
template <class D>
VEC_INLINE VectorOf<D> Sqrt(VectorOf<D> a) {
  using T = TFromD<D>;
#if defined(__x86_64__)
  if constexpr (sizeof a == 16) {
    if constexpr (sizeof(T) == 4) return {_mm_sqrt_ps(a.raw)};
    if constexpr (sizeof(T) == 8) return {_mm_sqrt_pd(a.raw)};
  }
#if VEC_TARGET <= VEC_AVX2
  if constexpr (sizeof a == 32) {
    if constexpr (sizeof(T) == 4) return {_mm256_sqrt_ps(a.raw)};
    if constexpr (sizeof(T) == 8) return {_mm256_sqrt_pd(a.raw)};
  }
#endif
#if VEC_TARGET == VEC_AVX512
  if constexpr (sizeof a == 64) {
    if constexpr (sizeof(T) == 4) return {_mm512_sqrt_ps(a.raw)};
    if constexpr (sizeof(T) == 8) return {_mm512_sqrt_pd(a.raw)};
  }
#endif
#endif
  auto v = a.raw;
  for (std::size_t k = 0; k < D::lanes; ++k) v[k] = std::sqrt(v[k]);
  return {v};
}
template <class D>
VEC_INLINE VectorOf<D> Abs(VectorOf<D> a) {
  using I = typename IntegerOf<sizeof(TFromD<D>)>::Unsigned;
  constexpr I all_but_sign = static_cast<I>(~I{0}) >> 1;
  return Vec<D>::of_bits(a.bits() & static_cast<typename IntegerOf<sizeof(TFromD<D>)>::Signed>(all_but_sign));
}

template <class To, class D>
VEC_INLINE Vec<To> BitCast(To, VectorOf<D> v) {
  return {reinterpret_cast<decltype(Vec<To>::raw)>(v.raw)};
}
template <class To, class D>
VEC_INLINE Vec<To> ConvertTo(To, VectorOf<D> v) {
  return {__builtin_convertvector(v.raw, typename Vec<To>::Lanes)};
}
template <int bits, class D>
VEC_INLINE VectorOf<D> ShiftLeft(VectorOf<D> v) {
  return {v.raw << bits};
}
template <int bits, class D>
VEC_INLINE VectorOf<D> ShiftRight(VectorOf<D> v) {
  return {v.raw >> bits};
}
template <class D>
VEC_INLINE VectorOf<D> And(VectorOf<D> a, VectorOf<D> b) {
  return Vec<D>::of_bits(a.bits() & b.bits());
}

// --- sums over lanes ------------------------------------------------------------------------------------

// Each time the upper half of the lanes that are left is added to the lower half. The indices of the lanes are
// arguments of templates, as the compiler may leave a loop over them as it is.
template <std::size_t apart, class D, std::size_t... k>
VEC_INLINE VectorOf<D> AddLanesApart(VectorOf<D> v, std::index_sequence<k...> all) {
  if constexpr (apart == 0) {
    return v;
  } else {
    const VectorOf<D> sums{v.raw + __builtin_shufflevector(v.raw, v.raw, (k ^ apart)...)};
    return AddLanesApart<apart / 2>(sums, all);
  }
}
// The sums of the two halves of a in the lower half, those of b in the upper half.
template <class D, std::size_t... k>
VEC_INLINE VectorOf<D> AddHalves(VectorOf<D> a, VectorOf<D> b, std::index_sequence<k...>) {
  constexpr std::size_t half = sizeof...(k) / 2;
  return {__builtin_shufflevector(a.raw, b.raw, (k < half ? k : k + half)...) +
          __builtin_shufflevector(a.raw, b.raw, (k < half ? k + half : k + 2 * half)...)};
}
template <class D>
VEC_INLINE TFromD<D> SumOfLanes(VectorOf<D> v) {
  return AddLanesApart<D::lanes / 2>(v, std::make_index_sequence<D::lanes>()).raw[0];
}
// Both sums for the price of one, with the same bits.
template <class D>
VEC_INLINE std::pair<TFromD<D>, TFromD<D>> SumsOfLanes(VectorOf<D> a, VectorOf<D> b) {
  constexpr std::make_index_sequence<D::lanes> all;
  const VectorOf<D> sums = AddLanesApart<D::lanes / 4>(AddHalves(a, b, all), all);
  return {sums.raw[0], sums.raw[D::lanes / 2]};
}

// --- comparisons and masks ------------------------------------------------------------------------------

#if VEC_TARGET == VEC_AVX512

template <class D>
VEC_INLINE Mask<D> Lt(VectorOf<D> a, VectorOf<D> b) {
  using T = TFromD<D>;
  const auto mask = [&]() VEC_ATTR {
    if constexpr (std::is_same_v<T, float>) {
      if constexpr (sizeof a == 64) return _mm512_cmp_ps_mask(a.raw, b.raw, _CMP_LT_OQ);
      if constexpr (sizeof a == 32) return _mm256_cmp_ps_mask(a.raw, b.raw, _CMP_LT_OQ);
      if constexpr (sizeof a == 16) return _mm_cmp_ps_mask(a.raw, b.raw, _CMP_LT_OQ);
    } else if constexpr (std::is_same_v<T, double>) {
      if constexpr (sizeof a == 64) return _mm512_cmp_pd_mask(a.raw, b.raw, _CMP_LT_OQ);
      if constexpr (sizeof a == 32) return _mm256_cmp_pd_mask(a.raw, b.raw, _CMP_LT_OQ);
      if constexpr (sizeof a == 16) return _mm_cmp_pd_mask(a.raw, b.raw, _CMP_LT_OQ);
    } else {
      static_assert(std::is_same_v<T, std::int32_t>);
      if constexpr (sizeof a == 64)
        return _mm512_cmplt_epi32_mask(reinterpret_cast<__m512i>(a.raw), reinterpret_cast<__m512i>(b.raw));
      if constexpr (sizeof a == 32)
        return _mm256_cmplt_epi32_mask(reinterpret_cast<__m256i>(a.raw), reinterpret_cast<__m256i>(b.raw));
      if constexpr (sizeof a == 16)
        return _mm_cmplt_epi32_mask(reinterpret_cast<__m128i>(a.raw), reinterpret_cast<__m128i>(b.raw));
    }
  };
  return {static_cast<typename Mask<D>::Raw>(mask())};
}
template <class D>
VEC_INLINE VectorOf<D> IfThenElse(Mask<D> m, VectorOf<D> yes, VectorOf<D> no) {
  using T = TFromD<D>;
  static_assert(std::is_floating_point_v<T>);
  if constexpr (sizeof(T) == 4) {
    if constexpr (sizeof yes == 64) return {_mm512_mask_blend_ps(m.raw, no.raw, yes.raw)};
    if constexpr (sizeof yes == 32) return {_mm256_mask_blend_ps(m.raw, no.raw, yes.raw)};
    if constexpr (sizeof yes == 16) return {_mm_mask_blend_ps(m.raw, no.raw, yes.raw)};
  } else {
    if constexpr (sizeof yes == 64) return {_mm512_mask_blend_pd(m.raw, no.raw, yes.raw)};
    if constexpr (sizeof yes == 32) return {_mm256_mask_blend_pd(m.raw, no.raw, yes.raw)};
    if constexpr (sizeof yes == 16) return {_mm_mask_blend_pd(m.raw, no.raw, yes.raw)};
  }
}
template <class D>
VEC_INLINE VectorOf<D> IfThenElseZero(Mask<D> m, VectorOf<D> yes) {
  return IfThenElse(m, yes, Zero(D()));
}
template <class D>
VEC_INLINE MaskOf<D> And(MaskOf<D> a, MaskOf<D> b) {
  return {static_cast<typename Mask<D>::Raw>(a.raw & b.raw)};
}
template <class D>
VEC_INLINE MaskOf<D> AndNot(MaskOf<D> a, MaskOf<D> b) {
  return {static_cast<typename Mask<D>::Raw>(~a.raw & b.raw)};
}
template <class D>
VEC_INLINE bool AllFalse(D, Mask<D> m) {
  return m.raw == 0;
}
template <class D>
VEC_INLINE std::uint64_t bits_of_mask(D, Mask<D> m) {
  return m.raw;
}
template <class To, class D>
VEC_INLINE Mask<To> RebindMask(To, MaskOf<D> m) {
  return {m.raw};
}
template <class D>
VEC_INLINE Vec<D> VecFromMask(D, Mask<D> m) {
  static_assert(std::is_same_v<TFromD<D>, float> && D::lanes == 16);
  return {_mm512_castsi512_ps(_mm512_movm_epi32(m.raw))};
}

#else

template <class D>
VEC_INLINE Mask<D> Lt(VectorOf<D> a, VectorOf<D> b) {
  return {a.raw < b.raw};
}
template <class D>
VEC_INLINE VectorOf<D> IfThenElse(Mask<D> m, VectorOf<D> yes, VectorOf<D> no) {
  return Vec<D>::of_bits((m.raw & yes.bits()) | (~m.raw & no.bits()));
}
template <class D>
VEC_INLINE VectorOf<D> IfThenElseZero(Mask<D> m, VectorOf<D> yes) {
  return Vec<D>::of_bits(m.raw & yes.bits());
}
template <class D>
VEC_INLINE MaskOf<D> And(MaskOf<D> a, MaskOf<D> b) {
  return {a.raw & b.raw};
}
template <class D>
VEC_INLINE MaskOf<D> AndNot(MaskOf<D> a, MaskOf<D> b) {
  return {~a.raw & b.raw};
}
template <class D>
VEC_INLINE std::uint64_t bits_of_mask(D, Mask<D> m) {
#if defined(__x86_64__)
  using T = TFromD<D>;
  if constexpr (sizeof m == 16 && sizeof(T) == 4)
    return static_cast<unsigned>(_mm_movemask_ps(reinterpret_cast<__m128>(m.raw)));
  if constexpr (sizeof m == 16 && sizeof(T) == 8)
    return static_cast<unsigned>(_mm_movemask_pd(reinterpret_cast<__m128d>(m.raw)));
#if VEC_TARGET == VEC_AVX2
  if constexpr (sizeof m == 32 && sizeof(T) == 4)
    return static_cast<unsigned>(_mm256_movemask_ps(reinterpret_cast<__m256>(m.raw)));
  if constexpr (sizeof m == 32 && sizeof(T) == 8)
    return static_cast<unsigned>(_mm256_movemask_pd(reinterpret_cast<__m256d>(m.raw)));
#endif
#endif
  std::uint64_t bits = 0;
  for (std::size_t k = 0; k < D::lanes; ++k) bits |= static_cast<std::uint64_t>(m.raw[k] != 0) << k;
  return bits;
}
template <class D>
VEC_INLINE bool AllFalse(D d, Mask<D> m) {
  return bits_of_mask(d, m) == 0;
}
template <class To, class D>
VEC_INLINE Mask<To> RebindMask(To, MaskOf<D> m) {
  return {m.raw};
}
template <class D>
VEC_INLINE Vec<D> VecFromMask(D, Mask<D> m) {
  return Vec<D>::of_bits(m.raw);
}
#endif

// No arithmetic with n, of which the compiler makes a branch.
template <class D, std::size_t... k>
VEC_INLINE Mask<D> LanesBelow(D, int n, std::index_sequence<k...>) {
#if VEC_TARGET == VEC_AVX512
  using I = Simd<std::int32_t, D::lanes>;
#else
  using I = RebindToSigned<D>;
#endif
  return {Lt(Vec<I>{typename Vec<I>::Lanes{k...}}, Set(I(), n)).raw};
}
template <class D>
VEC_INLINE Mask<D> FirstN(D d, int n) {
  return LanesBelow(d, n, std::make_index_sequence<D::lanes>());
}
template <class D>
VEC_INLINE Mask<D> Gt(VectorOf<D> a, VectorOf<D> b) {
  return Lt(b, a);
}
template <class D>
VEC_INLINE VectorOf<D> Min(VectorOf<D> a, VectorOf<D> b) {
#if VEC_TARGET == VEC_AVX512
  if constexpr (std::is_same_v<TFromD<D>, float> && sizeof a == 64) return {_mm512_min_ps(a.raw, b.raw)};
  if constexpr (std::is_same_v<TFromD<D>, double> && sizeof a == 64) return {_mm512_min_pd(a.raw, b.raw)};
#endif
  return {a.raw < b.raw ? a.raw : b.raw};
}
template <class D>
VEC_INLINE VectorOf<D> Max(VectorOf<D> a, VectorOf<D> b) {
#if VEC_TARGET == VEC_AVX512
  if constexpr (std::is_same_v<TFromD<D>, float> && sizeof a == 64) return {_mm512_max_ps(a.raw, b.raw)};
  if constexpr (std::is_same_v<TFromD<D>, double> && sizeof a == 64) return {_mm512_max_pd(a.raw, b.raw)};
#endif
  return {a.raw > b.raw ? a.raw : b.raw};
}

// --- some lanes -----------------------------------------------------------------------------------------

#if VEC_TARGET <= VEC_AVX2
template <class D>
VEC_INLINE Vec<D> MaskedLoad(Mask<D> m, D, const double* p) {
#if VEC_TARGET == VEC_AVX512
  if constexpr (D::lanes == 8) return {_mm512_maskz_loadu_pd(m.raw, p)};
  if constexpr (D::lanes == 4) return {_mm256_maskz_loadu_pd(m.raw, p)};
#else
  static_assert(D::lanes == 4);
  return {_mm256_maskload_pd(p, reinterpret_cast<__m256i>(m.raw))};
#endif
}
#endif

// The lanes of the mask one after another; a whole vector may be written. Returns their number.
template <class D>
VEC_INLINE std::size_t CompressStore(Vec<D> v, Mask<D> m, D d, std::int32_t* to) {
  std::uint64_t bits = bits_of_mask(d, m);
#if VEC_TARGET == VEC_AVX512
  if constexpr (sizeof v == 64) {
    _mm512_storeu_si512(to, _mm512_maskz_compress_epi32(m.raw, reinterpret_cast<__m512i>(v.raw)));
    return static_cast<std::size_t>(__builtin_popcountll(bits));
  }
#endif
  std::int32_t all[D::lanes];
  Store(v, d, all);
  std::size_t count = 0;
  for (; bits != 0; bits &= bits - 1) to[count++] = all[first_bit(bits)];
  return count;
}

// --- look-ups -------------------------------------------------------------------------------------------

template <class D, class I>
VEC_INLINE Vec<D> GatherIndex(D, const TFromD<D>* table, VectorOf<I> index) {
#if VEC_TARGET == VEC_AVX512
  if constexpr (sizeof(TFromD<D>) == 8 && D::lanes == 8)
    return {_mm512_i64gather_pd(reinterpret_cast<__m512i>(index.raw), table, 8)};
#elif VEC_TARGET == VEC_AVX2
  if constexpr (sizeof(TFromD<D>) == 8 && D::lanes == 4)
    return {_mm256_i64gather_pd(table, reinterpret_cast<__m256i>(index.raw), 8)};
#endif
  typename Vec<D>::Lanes v;
  for (std::size_t k = 0; k < D::lanes; ++k) v[k] = table[index.raw[k]];
  return {v};
}
template <class D, class I>
VEC_INLINE VectorOf<D> TableLookupLanes(VectorOf<D> table, VectorOf<I> index) {
#ifdef __clang__  // its shuffles want the index at compile time
  typename VectorOf<D>::Lanes v;
  for (std::size_t k = 0; k < D::lanes; ++k) v[k] = table.raw[static_cast<std::size_t>(index.raw[k]) % D::lanes];
  return {v};
#else
  return {__builtin_shuffle(table.raw, index.raw)};
#endif
}
#if VEC_TARGET == VEC_AVX2
// The same four numbers in both halves.
template <class D>
VEC_INLINE Vec<D> LoadDup128(D, const float* p) {
  static_assert(D::lanes == 8);
  const __m128 four = _mm_loadu_ps(p);
  return {_mm256_insertf128_ps(_mm256_castps128_ps256(four), four, 1)};
}
#endif

}  // namespace VEC_SET
}  // namespace ropewalk::vec
VEC_AFTER_NAMESPACE();

#endif  // per target
