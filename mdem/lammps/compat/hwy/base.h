// The operations of the Highway library that the kernels of mdem/sim use, over the compiler's own vectors: for
// programs that must not link Debian's Highway, whose licence (Apache-2.0) does not go with GPL-2. Names and
// meanings are those of its manual; nothing is copied from it. GCC; for x86-64 also with the compiler's intrinsics.
#pragma once

#include <cstddef>
#include <cstdint>

#define HWY_INLINE inline __attribute__((always_inline))
#define HWY_NOINLINE __attribute__((noinline))
#define HWY_LIKELY(x) __builtin_expect(static_cast<bool>(x), 1)

// Instruction sets, best first. The last one is what the compiler makes without being told; HWY_SCALAR is never
// made.
#define HWY_AVX3 1
#define HWY_AVX2 2
#define HWY_SSSE3 4
#define HWY_SSE4 8
#define HWY_SCALAR 16
#define HWY_STATIC_TARGET HWY_SSE4

#ifndef HWY_DISABLED_TARGETS
#define HWY_DISABLED_TARGETS 0
#endif
#if defined(__x86_64__)
#define HWY_TARGETS ((HWY_AVX3 | HWY_AVX2 | HWY_STATIC_TARGET) & (HWY_STATIC_TARGET | ~(HWY_DISABLED_TARGETS)))
#else
#define HWY_TARGETS HWY_STATIC_TARGET
#endif

namespace hwy {

// Places in a table of functions (HWY_EXPORT).
enum Set { avx3, avx2, compiled };

inline std::int64_t& targets_for_test() {
  static std::int64_t targets = 0;
  return targets;
}
inline void SetSupportedTargetsForTest(std::int64_t targets) { targets_for_test() = targets; }

inline std::int64_t SupportedTargets() {
  if (targets_for_test() != 0) return targets_for_test();
  std::int64_t targets = HWY_STATIC_TARGET;
#if defined(__x86_64__)
  const auto has = [](bool yes, std::int64_t set) { return yes ? set : 0; };
  const bool v3 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2");
  targets |= has(v3, HWY_AVX2);
  targets |= has(v3 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
                     __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl"),
                 HWY_AVX3);
#endif
  return targets & HWY_TARGETS;
}

inline const char* TargetName(std::int64_t target) {
  return target == HWY_AVX3 ? "AVX3" : target == HWY_AVX2 ? "AVX2" : "baseline";
}

struct ChosenTarget {
  Set set = compiled;
  void Update(std::int64_t targets) { set = targets & HWY_AVX3 ? avx3 : targets & HWY_AVX2 ? avx2 : compiled; }
};
inline ChosenTarget& GetChosenTarget() {
  static ChosenTarget chosen = [] {
    ChosenTarget best;
    best.Update(SupportedTargets());
    return best;
  }();
  return chosen;
}

inline std::size_t Num0BitsBelowLS1Bit_Nonzero64(std::uint64_t x) {
  return static_cast<std::size_t>(__builtin_ctzll(x));
}

}  // namespace hwy
