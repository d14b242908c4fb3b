// The line law: one radial evaluation, the kernel for every instruction set and precision, its damping and its
// list. It contains the kernel's source, whose inner functions no header shows: what is measured is what is
// shipped.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bench/line_kernel.cpp"
#include <hwy/foreach_target.h>
//
#include "sim/contact/line/kernel.cpp"
// The source has named itself; the passes for the other instruction sets must come here.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bench/line_kernel.cpp"

HWY_BEFORE_NAMESPACE();
namespace ropewalk::HWY_NAMESPACE {

// u and du/dy of n squared distances, added up: `out` has two vectors' room. n is a multiple of 16.
template <class Table>
HWY_INLINE void radial_row(const Table& table, const typename Table::Value* X, std::size_t n,
                           typename Table::Value* out) {
  const typename Lanes<typename Table::Value>::D d;
  auto us = hn::Zero(d), slopes = hn::Zero(d);
  for (std::size_t i = 0; i < n; i += hn::Lanes(d)) {
    using V = hn::Vec<typename Lanes<typename Table::Value>::D>;
    const V at[1] = {hn::Load(d, X + i)};
    const V by[1] = {hn::Set(d, 1)};
    V u[1], slope[1];
    radial<true>(d, table, at, by, u, slope);
    us = hn::Add(us, u[0]);
    slopes = hn::Add(slopes, slope[0]);
  }
  hn::StoreU(us, d, out);
  hn::StoreU(slopes, d, out + hn::Lanes(d));
}

void RadialMixed(const MixedTable& table, const float* X, std::size_t n, float* out) {
  radial_row(table, X, n, out);
}
void RadialFull(const FullTable& table, const double* X, std::size_t n, double* out) {
  radial_row(table, X, n, out);
}

// 64 runs of `length` nodes, each `shift` nodes after the one before, against as many nodes of an element as the
// kernel takes together.
void Rows(const MixedTable& table, const LineNodes<std::int32_t>& nodes, int length, int shift,
          NodeForces<float>& out, float* total) {
  using D = Lanes<float>::D;
  constexpr int K = nodes_at_once<float>;
  std::int32_t from[K][3] = {};
  for (int k = 0; k < K; ++k) from[k][2] = k << 20;
  auto sums = no_sums<D, K>(D());
  for (int r = 0; r < 64; ++r)
    meet_row<false, K>(table, nodes, out, {r * shift, static_cast<short>(length), 0, 0}, from, 0.1F, sums);
  auto all = sums.energy;
  for (int k = 0; k < K; ++k) all = hn::Add(all, hn::Add(sums.x[k], hn::Add(sums.y[k], sums.z[k])));
  hn::StoreU(all, D(), total);
}

int NodesAtOnce() { return nodes_at_once<float>; }
std::size_t KernelLanes(bool full) { return full ? hn::Lanes(Lanes<double>::D()) : hn::Lanes(Lanes<float>::D()); }

}  // namespace ropewalk::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "bench/line_count.hpp"
#include "bench/support.hpp"
#include "sim/threads/vector_clones.hpp"

namespace ropewalk {
HWY_EXPORT(RadialMixed);
HWY_EXPORT(RadialFull);
HWY_EXPORT(KernelLanes);
HWY_EXPORT(NodesAtOnce);
HWY_EXPORT(Rows);
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

// Without separation, square, force and sums of forces; two more for each term of u.
double radial_flop(Precision precision, int degree) {
  return radial_operations(precision) - (3 + 5 + 1 + 12) + 2 * degree;
}

void RadialTableFloat(benchmark::State& bench, const std::string& instructions) {
  use_instructions(instructions);
  const MixedTable table(test::line_density(), 1);
  const Distances<float> at;
  float out[32];
  for (auto _ : bench) {
    HWY_DYNAMIC_DISPATCH(RadialMixed)(table, at.X, distances, out);
    benchmark::ClobberMemory();
  }
  set_ns(bench, "ns/evaluation", distances);
  set_giga(bench, "GFLOP/s", distances * radial_flop(Precision::mixed, MixedTable::degree));
  use_instructions("");
}

void RadialTableDouble(benchmark::State& bench, const std::string& instructions) {
  use_instructions(instructions);
  const FullTable table(test::line_density(), 1);
  const Distances<double> at;
  double out[16];
  for (auto _ : bench) {
    HWY_DYNAMIC_DISPATCH(RadialFull)(table, at.X, distances, out);
    benchmark::ClobberMemory();
  }
  set_ns(bench, "ns/evaluation", distances);
  set_giga(bench, "GFLOP/s", distances * radial_flop(Precision::full, FullTable::degree));
  use_instructions("");
}

// Runs alone, two or four nodes of an element against each. Arguments: nodes in a run; nodes from one run to the
// next: as many as a run has, it meets fresh forces, 0 those just stored, 6 those of the last runs, shifted by an
// element.
void LineRows(benchmark::State& bench) {
  const int length = static_cast<int>(bench.range(0)), shift = static_cast<int>(bench.range(1));
  const int count = 64 * shift + length + NodeRow::pad;
  const double unit = std::exp2(-22);
  const MixedTable table(test::line_density(), unit);
  LineNodes<std::int32_t> nodes;
  const auto coordinate = [&](double nm) { return static_cast<std::int32_t>(std::lrint(nm / unit)); };
  for (int m = 0; m < count; ++m) {
    nodes.x.push_back(coordinate(1.7));
    nodes.y.push_back(coordinate(0.01 * (m % 7)));
    nodes.z.push_back(coordinate(0.226 * (m % 10)));
  }
  NodeForces<float> forces;
  forces.make_room(count);
  forces.start(1);
  float total[16];
  for (auto _ : bench) {
    HWY_DYNAMIC_DISPATCH(Rows)(table, nodes, length, shift, forces, total);
    benchmark::ClobberMemory();
  }
  const auto lanes = static_cast<int>(HWY_DYNAMIC_DISPATCH(KernelLanes)(false));
  const double vectors = 64.0 * HWY_DYNAMIC_DISPATCH(NodesAtOnce)() * ((length + lanes - 1) / lanes);
  set_ns(bench, "ns/vector", vectors);
  set_ns(bench, "ns/run", 64);
  set_giga(bench, "GFLOP/s", vectors * lanes * radial_operations(Precision::mixed));
}
BENCHMARK(LineRows)->ArgsProduct({{16, 32}, {0, 6, 32}})->Args({24, 6})->Args({512, 512});

// The law itself, as its formula says: what the tables replace.
ROPEWALK_VECTOR_CLONES
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
  bench.counters["vectors"] = count.vectors;
  bench.counters["useful"] = count.useful / count.evaluations;
  bench.counters["runs"] = count.runs;
  bench.counters["skipped"] = count.skipped;
  bench.counters["end_pairs"] = count.pairs;
  bench.counters["pairs"] = static_cast<double>(rope.list.pairs()) / n;
}

// --- Benchmarks -------------------------------------------------------------------------------------

struct Choice {
  std::string instructions;
  Precision precision;
  Law law;
  int tubes;
  double worn;
  bool energies = false;
};

// Rows, kernel and what it puts on the neighbours: all of the contact, as a step has it.
void LineKernel(benchmark::State& bench, const Choice& c) {
  use_instructions(c.instructions);
  const Rope rope(c.tubes, 49, c.law, c.precision, 0, c.worn);
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

// What the tubes collect from the chunks, alone.
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
  for (auto _ : bench) list.build(rope.topology, rope.in, rope.list);
  set_ns(bench, "ns/element", rope.elements());
  bench.counters["runs"] = static_cast<double>(list.runs()) / rope.elements();
  bench.counters["bytes"] = static_cast<double>(list.bytes()) / rope.elements();
}
BENCHMARK(LineListBuild)->Arg(7)->Arg(91);

template <class T>
void ViscousDamping(benchmark::State& bench) {
  constexpr bool mixed = std::is_same_v<T, float>;
  const Rope rope(static_cast<int>(bench.range(0)), 49, Law::line, mixed ? Precision::mixed : Precision::full, 20);
  LineList list;
  list.build(rope.topology, rope.in, rope.list);
  const ContactViscosity& viscosity = rope.in.damping.contact;
  std::vector<ContactBuffer<T>> buffers(list.chunks().size());
  DampedElements floats;
  floats.make_room(list.most_elements());
  for (auto _ : bench) {
    for (std::size_t k = 0; k < buffers.size(); ++k) {
      const LineChunk& chunk = list.chunks()[k];
      buffers[k].clear(static_cast<std::size_t>(chunk.elements));
      if constexpr (mixed)
        contact_damping(viscosity, rope.state, {chunk.damped, chunk.damped_parts, list.unit()}, floats, buffers[k]);
      else
        contact_damping(viscosity, rope.state, chunk.damped, buffers[k]);
    }
    benchmark::ClobberMemory();
  }
  set_ns(bench, "ns/element", rope.elements());
}
BENCHMARK_TEMPLATE(ViscousDamping, float)->Arg(7)->Arg(91);
BENCHMARK_TEMPLATE(ViscousDamping, double)->Arg(7)->Arg(91);

void register_kernel(const Choice& c, const std::string& also = "") {
  const std::string name = "LineKernel/" + c.instructions + (c.precision == Precision::full ? "/full" : "/mixed") +
                           (c.law == Law::line ? "/sparse/" : "/all_nodes/") + std::to_string(c.tubes) + also;
  benchmark::RegisterBenchmark(name.c_str(), LineKernel, c)->Unit(benchmark::kMicrosecond);
}

void register_kernels() {
  for (const std::string& instructions : instruction_sets())
    for (const Precision precision : {Precision::mixed, Precision::full})
      for (const Law law : {Law::line, Law::line_all_nodes})
        for (const int tubes : {7, 91}) register_kernel({instructions, precision, law, tubes, 0.5});
  for (const Law law : {Law::line, Law::line_all_nodes})
    register_kernel({instruction_sets()[0], Precision::mixed, law, 91, 0}, "/fresh_list");
  register_kernel({instruction_sets()[0], Precision::mixed, Law::line, 91, 0.5, true}, "/energies");
}

const bool registered = [] {
  for (const std::string& name : instruction_sets()) {
    benchmark::RegisterBenchmark(("RadialTableFloat/" + name).c_str(), RadialTableFloat, name);
    benchmark::RegisterBenchmark(("RadialTableDouble/" + name).c_str(), RadialTableDouble, name);
  }
  register_kernels();
  return true;
}();

}  // namespace
}  // namespace ropewalk::bench
#endif  // HWY_ONCE
