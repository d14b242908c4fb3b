// The line law: one radial evaluation, the kernel for every instruction set and precision, its damping and its
// list. It contains the kernel's source, whose inner functions no header shows: the measured code is the
// shipped code.
#undef VEC_SOURCE
#define VEC_SOURCE "bench/line_kernel.cpp"
#include "sim/vectors/each_set-inl.hpp"
//
#include "sim/contact/line/kernel.cpp"
// The source has named itself; the passes for the other instruction sets must come here.
#undef VEC_SOURCE
#define VEC_SOURCE "bench/line_kernel.cpp"

VEC_BEFORE_NAMESPACE();
namespace ropewalk::VEC_SET {

// u and du/dy of n squared distances, added up: `out` has two vectors' room. n is a multiple of 16.
template <class Table>
VEC_INLINE void radial_row(const Table& table, const typename Table::Value* X, std::size_t n,
                           typename Table::Value* out) {
  const typename Lanes<typename Table::Value>::D d;
  auto us = ops::Zero(d), slopes = ops::Zero(d);
  for (std::size_t i = 0; i < n; i += ops::Lanes(d)) {
    using V = ops::Vec<typename Lanes<typename Table::Value>::D>;
    const V at[1] = {ops::Load(d, X + i)};
    V u[1], slope[1];
    radial<true>(d, table, at, u, slope);
    us = ops::Add(us, u[0]);
    slopes = ops::Add(slopes, slope[0]);
  }
  ops::Store(us, d, out);
  ops::Store(slopes, d, out + ops::Lanes(d));
}

void RadialMixed(const MixedTable& table, const float* X, std::size_t n, float* out) {
  radial_row(table, X, n, out);
}
void RadialFull(const FullTable& table, const double* X, std::size_t n, double* out) {
  radial_row(table, X, n, out);
}

}  // namespace ropewalk::VEC_SET
VEC_AFTER_NAMESPACE();

#if VEC_ONCE
#include "bench/line_count.hpp"
#include "bench/support.hpp"
#include "sim/contact/line/engine.hpp"
#include "sim/threads/vector_unit.hpp"

namespace ropewalk {
VEC_EXPORT(RadialMixed);
VEC_EXPORT(RadialFull);
}  // namespace ropewalk

namespace ropewalk::bench {
namespace {

using Precision = Interaction::Precision;

constexpr std::size_t distances = 1024;

// Squared distances from the core to the cutoff.
template <class T>
struct Distances {
  alignas(64) T X[distances];
  Distances() {
    const LineDensity law = test::line_density();
    test::Random random(7);
    for (T& x : X) {
      const double rho = random.uniform(law.contact + law.core_gap, law.cutoff());
      x = static_cast<T>(rho * rho);
    }
  }
};

// Without the squared distance and the sums of forces; two more for each term of u.
double radial_flop(Precision precision, int degree) { return radial_operations(precision) - (3 + 3) + 2 * degree; }

template <class Table, Precision precision, class Radial>
void RadialTableOf(benchmark::State& bench, const std::string& instructions, Radial radial) {
  use_instructions(instructions);
  const Table table(test::line_density(), 1);
  const Distances<typename Table::Value> at;
  typename Table::Value out[32];
  for (auto _ : bench) {
    radial(table, at.X, distances, out);
    benchmark::ClobberMemory();
  }
  set_ns(bench, "ns/evaluation", distances);
  set_giga(bench, "GFLOP/s", distances * radial_flop(precision, Table::degree));
  use_instructions("");
}

// The law itself, as its formula says: what the tables replace.
#ifdef ROPEWALK_HAS_VECTOR_UNITS
__attribute__((target_clones("default", "arch=x86-64-v3", "arch=x86-64-v4")))
#endif
void radial_direct(const LineDensity& of, const double* X, double& u, double& slope) {
  const LineDensity law = of;
  double us = 0, slopes = 0;
#pragma omp simd reduction(+ : us, slopes)
  for (std::size_t i = 0; i < distances; ++i) {
    const double rho = std::sqrt(X[i]);
    const RadialTerms t = law.terms(rho);
    us += t.energy;
    slopes += t.derivative / rho;
  }
  u = us;
  slope = slopes;
}

void RadialDirect(benchmark::State& bench) {
  const LineDensity law = test::line_density();
  const Distances<double> at;
  double u = 0, slope = 0;
  for (auto _ : bench) {
    radial_direct(law, at.X, u, slope);
    benchmark::DoNotOptimize(u);
    benchmark::DoNotOptimize(slope);
  }
  set_ns(bench, "ns/evaluation", distances);
}
BENCHMARK(RadialDirect);

void set_counters(benchmark::State& bench, const Rope& rope, const LineList& list) {
  const RadialCount count =
      count_radial(rope.topology, rope.in, rope.state, rope.list, list, rope.topology.elements());
  const double n = rope.elements();
  set_ns(bench, "ns/element", n);
  set_ns(bench, "ns/evaluation", count.evaluations * n);
  set_giga(bench, "GFLOP/s", count.evaluations * n * radial_operations(rope.in.precision));
  bench.counters["evaluations"] = count.evaluations;
  bench.counters["useful"] = count.useful / count.evaluations;
  bench.counters["spans"] = count.spans;
  bench.counters["skipped"] = count.skipped;
  bench.counters["pairs"] = static_cast<double>(rope.list.pairs()) / n;
}

// --- Benchmarks -------------------------------------------------------------------------------------

struct Choice {
  std::string instructions;
  Precision precision;
  int tubes;
  double worn;
  bool energies = false;
};

// Rows, kernel and what it puts on the neighbours: all of the contact, as a step has it.
void LineKernel(benchmark::State& bench, const Choice& c) {
  use_instructions(c.instructions);
  const Rope rope(c.tubes, 49, Law::line, c.precision, 0, c.worn);
  LineEngine engine;
  Vec3Array force(rope.state.size()), torque(rope.state.size());
  const auto nothing = [](int) {};
  const TubeParts parts(rope.topology);
  const auto finish = [&](int block) {
    for (int k = parts.block_begin(block); k < parts.block_begin(block + 1); ++k)
      engine.add_to(k, {force, torque, 0});
  };
  for (auto _ : bench) {
    engine.compute(rope.topology, rope.in, rope.list, rope.state, rope.axis, c.energies, {parts, nothing, finish});
    benchmark::ClobberMemory();
  }
  set_counters(bench, rope, engine.list());
  use_instructions("");
}

// The collection of the chunks' forces by the tubes, alone.
void LineCollect(benchmark::State& bench) {
  const Rope rope(static_cast<int>(bench.range(0)), 49, Law::line);
  LineEngine engine;
  Vec3Array force(rope.state.size()), torque(rope.state.size());
  const TubeParts parts(rope.topology);
  const auto nothing = [](int) {};
  engine.compute(rope.topology, rope.in, rope.list, rope.state, rope.axis, false, {parts, nothing, nothing});
  for (auto _ : bench) {
    for (int k = 0; k < parts.count(); ++k) engine.add_to(k, {force, torque, 0});
    benchmark::ClobberMemory();
  }
  set_ns(bench, "ns/element", rope.elements());
}
BENCHMARK(LineCollect)->Arg(7)->Arg(91);

void LineListBuild(benchmark::State& bench) {
  const Rope rope(static_cast<int>(bench.range(0)), 49, Law::line, Precision::mixed, 20);
  LineList list;
  for (auto _ : bench) list.build(rope.topology, rope.in, rope.list, nullptr);
  set_ns(bench, "ns/element", rope.elements());
  bench.counters["spans"] = static_cast<double>(list.spans()) / rope.elements();
  bench.counters["bytes"] = static_cast<double>(list.bytes()) / rope.elements();
}
BENCHMARK(LineListBuild)->Arg(7)->Arg(91);

template <class T>
void ViscousDamping(benchmark::State& bench) {
  constexpr bool mixed = std::is_same_v<T, float>;
  const Rope rope(static_cast<int>(bench.range(0)), 49, Law::line, mixed ? Precision::mixed : Precision::full, 20);
  ForceTerms terms;
  terms.use(rope.in);
  terms.prepare(rope.topology, rope.list, rope.state);
  terms.begin(rope.state, 0);
  LineList list;
  list.build(rope.topology, rope.in, rope.list, terms.pairs());
  std::vector<ContactBuffer<T>> buffers(list.chunks().size());
  for (auto _ : bench) {
    for (std::size_t k = 0; k < buffers.size(); ++k) {
      buffers[k].clear(static_cast<std::size_t>(list.chunks()[k].elements));
      terms.pairs()->add(k, buffers[k]);
    }
    benchmark::ClobberMemory();
  }
  set_ns(bench, "ns/element", rope.elements());
}
BENCHMARK_TEMPLATE(ViscousDamping, float)->Arg(7)->Arg(91);
BENCHMARK_TEMPLATE(ViscousDamping, double)->Arg(7)->Arg(91);

void register_kernel(const Choice& c, const std::string& also = "") {
  const std::string name = "LineKernel/" + c.instructions +
                           (c.precision == Precision::full ? "/full/" : "/mixed/") + std::to_string(c.tubes) + also;
  benchmark::RegisterBenchmark(name.c_str(), LineKernel, c)->Unit(benchmark::kMicrosecond);
}

void register_kernels() {
  for (const std::string& instructions : instruction_sets())
    for (const Precision precision : {Precision::mixed, Precision::full})
      for (const int tubes : {7, 91}) register_kernel({instructions, precision, tubes, 0.5});
  register_kernel({instruction_sets()[0], Precision::mixed, 91, 0}, "/fresh_list");
  register_kernel({instruction_sets()[0], Precision::mixed, 91, 0.5, true}, "/energies");
}

const bool registered = [] {
  for (const std::string& name : instruction_sets()) {
    benchmark::RegisterBenchmark(("RadialTableFloat/" + name).c_str(), [name](benchmark::State& bench) {
      RadialTableOf<MixedTable, Precision::mixed>(bench, name, [](auto&&... a) { VEC_IN_USE(RadialMixed)(a...); });
    });
    benchmark::RegisterBenchmark(("RadialTableDouble/" + name).c_str(), [name](benchmark::State& bench) {
      RadialTableOf<FullTable, Precision::full>(bench, name, [](auto&&... a) { VEC_IN_USE(RadialFull)(a...); });
    });
  }
  register_kernels();
  return true;
}();

}  // namespace
}  // namespace ropewalk::bench
#endif  // VEC_ONCE
