// The peak of this machine, for one thread: arithmetic (fused multiply-adds, products and sums where there
// are none), lookups in a table held in registers, and transfer. The roofline that the kernels are held to.
#undef VEC_SOURCE
#define VEC_SOURCE "bench/peak.cpp"
#include "sim/vectors/each_set-inl.hpp"
//
#include <cstddef>

#include "sim/vectors/operations-inl.hpp"

VEC_BEFORE_NAMESPACE();
namespace ropewalk::bench::VEC_SET {
namespace ops = vec::VEC_SET;

// Lookups in 32 floats in two registers; 0 where an instruction set has none.
std::size_t LookUp([[maybe_unused]] std::size_t rounds, [[maybe_unused]] const float* table,
                   [[maybe_unused]] float* out) {
#if VEC_TARGET <= VEC_AVX512
  constexpr int chains = 12;  // independent, as in bench/machine_peak.cpp
  const ops::CappedTag<float, 16> d;
  const auto low = ops::Load(d, table), high = ops::Load(d, table + 16);
  ops::Vec<decltype(d)> a[chains];
  for (int k = 0; k < chains; ++k) a[k] = ops::Set(d, static_cast<float>(k));
  for (std::size_t r = 0; r < rounds; ++r)
    for (int k = 0; k < chains; ++k)
      a[k].raw = _mm512_permutex2var_ps(low.raw, _mm512_castps_si512(a[k].raw), high.raw);
  for (int k = 1; k < chains; ++k) a[0] = ops::Add(a[0], a[k]);
  ops::Store(a[0], d, out);
  return rounds * chains * 16;
#else
  return 0;
#endif
}

}  // namespace ropewalk::bench::VEC_SET
VEC_AFTER_NAMESPACE();

#if VEC_ONCE

#include "bench/machine_peak.hpp"
#include "bench/support.hpp"
#include "sim/contact/line/engine.hpp"

namespace ropewalk::bench {

VEC_EXPORT(LookUp);

namespace {

template <class T>
void PeakOf(benchmark::State& bench, const std::string& instructions) {
  use_instructions(instructions);
  T factor = 0.5, out[64 / sizeof(T)];
  std::size_t flop = 0;
  for (auto _ : bench) {
    benchmark::DoNotOptimize(factor);
    flop = multiply_adds(10000, factor, out);
    benchmark::DoNotOptimize(out);
  }
  set_giga(bench, "GFLOP/s", static_cast<double>(flop));
  use_instructions("");
}

void PeakLookUp(benchmark::State& bench) {
  float table[32], out[16];
  for (int k = 0; k < 32; ++k) table[k] = 1 + static_cast<float>(k) / 64;
  std::size_t entries = 0;
  for (auto _ : bench) {
    benchmark::DoNotOptimize(table);
    entries = VEC_IN_USE(LookUp)(10000, table, out);
    benchmark::DoNotOptimize(out);
  }
  if (entries == 0) return bench.SkipWithError("no lookups in registers here");
  set_giga(bench, "Glookup/s", static_cast<double>(entries));
}
BENCHMARK(PeakLookUp);

// Argument: KiB of the three arrays together. Counts 24 bytes per entry, as STREAM does.
void PeakTriad(benchmark::State& bench) {
  const auto n = static_cast<std::size_t>(bench.range(0)) * 1024 / 24 / 8 * 8;
  const auto array = [&] {
    return std::unique_ptr<double[], decltype(&std::free)>(
        static_cast<double*>(std::aligned_alloc(64, n * sizeof(double))), &std::free);
  };
  const auto a = array(), b = array(), c = array();
  std::fill(a.get(), a.get() + n, 1.0);
  std::fill(b.get(), b.get() + n, 2.0);
  std::fill(c.get(), c.get() + n, 3.0);
  for (auto _ : bench) {
    triad(a.get(), b.get(), c.get(), n);
    benchmark::ClobberMemory();
  }
  set_giga(bench, "GB/s", 24.0 * static_cast<double>(n));
}
BENCHMARK(PeakTriad)->Arg(24)->Arg(512)->Arg(8 << 10)->Arg(384 << 10);

const bool registered = [] {
  for (const std::string& name : instruction_sets()) {
    benchmark::RegisterBenchmark(("PeakFloat/" + name).c_str(), PeakOf<float>, name);
    benchmark::RegisterBenchmark(("PeakDouble/" + name).c_str(), PeakOf<double>, name);
  }
  return true;
}();

}  // namespace
}  // namespace ropewalk::bench
#endif  // VEC_ONCE
