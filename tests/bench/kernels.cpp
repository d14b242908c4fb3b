// The forms alone, the paper law, lists, motion, and whole force evaluations.
#include "bench/support.hpp"
#include "sim/contact/line/engine.hpp"
#include "sim/contact/paper/engine.hpp"
#include "sim/state/motion.hpp"
#include "sim/state/part_of_scene.hpp"

namespace ropewalk::bench {
namespace {

void PaperPair(benchmark::State& bench) {
  const PaperContact law = test::published_contact();
  test::Random random(1);
  std::vector<Vector3> separation, ni, nj;
  for (int k = 0; k < 256; ++k) {
    separation.push_back(random.uniform(1.6, 5.4) * random.direction());
    ni.push_back(random.direction());
    nj.push_back(random.direction());
  }
  std::size_t k = 0;
  for (auto _ : bench) {
    benchmark::DoNotOptimize(law.energy_and_gradient(separation[k], ni[k], nj[k]));
    k = (k + 1) % separation.size();
  }
}
BENCHMARK(PaperPair);

void Bond(benchmark::State& bench) {
  const BondStiffness k = test::published_bond();
  test::Random random(2);
  const Frame i = frame_of(random.orientation()), j = frame_of(test::turn(random.direction(), 0.1));
  const Vector3 separation(0.1, 0, 1.35);
  for (auto _ : bench)
    benchmark::DoNotOptimize(bond_energy_and_gradient(k, test::element_length, separation, i, j));
}
BENCHMARK(Bond);

// The contact as a step has it, for every instruction set and precision. Tubes of 50 elements, as in all that
// follow.
void PaperKernel(benchmark::State& bench, const std::string& instructions, Interaction::Precision precision) {
  use_instructions(instructions);
  const Rope rope(static_cast<int>(bench.range(0)), 50, Law::paper, precision);
  PaperEngine engine;
  const TubeParts parts(rope.topology);
  const auto nothing = [](int) {};
  for (auto _ : bench) {
    engine.compute(rope.topology, rope.in, rope.list, rope.state, rope.axis, true, {parts, nothing, nothing});
    benchmark::ClobberMemory();
  }
  set_ns(bench, "ns/element", rope.elements());
  set_ns(bench, "ns/pair", static_cast<double>(rope.list.pairs()));
  bench.counters["spans"] = static_cast<double>(engine.spans().count()) / rope.elements();
  use_instructions("");
}

const bool registered = [] {
  for (const std::string& name : instruction_sets()) {
    for (const auto precision : {Interaction::Precision::mixed, Interaction::Precision::full}) {
      const char* how = precision == Interaction::Precision::full ? "/full" : "/mixed";
      benchmark::RegisterBenchmark(("PaperKernel/" + name + how).c_str(), PaperKernel, name, precision)
          ->Arg(7)
          ->Arg(91)
          ->Unit(benchmark::kMicrosecond);
    }
  }
  return true;
}();

void PaperSpansBuild(benchmark::State& bench) {
  const Rope rope(static_cast<int>(bench.range(0)), 50, Law::paper);
  ElementSpans spans;
  for (auto _ : bench) spans.build(rope.list, rope.in.cutoff());
  set_ns(bench, "ns/element", rope.elements());
}
BENCHMARK(PaperSpansBuild)->Arg(7)->Arg(91);

void NeighbourListBuild(benchmark::State& bench) {
  const Rope rope(static_cast<int>(bench.range(0)), 50, Law::line);
  NeighbourList list = rope.list;
  for (auto _ : bench) list.build(rope.topology, rope.state);
  set_ns(bench, "ns/element", rope.elements());
  bench.counters["pairs"] = static_cast<double>(list.pairs()) / rope.elements();
}
BENCHMARK(NeighbourListBuild)->Arg(7)->Arg(91);

// The cost, in every step, of finding that the list still holds.
void NeighbourListCheck(benchmark::State& bench) {
  Rope rope(static_cast<int>(bench.range(0)), 50, Law::line);
  for (auto _ : bench) benchmark::DoNotOptimize(rope.list.update(rope.topology, rope.state));
  set_ns(bench, "ns/element", rope.elements());
}
BENCHMARK(NeighbourListCheck)->Arg(7)->Arg(91);

void Motion(benchmark::State& bench) {
  Rope rope(static_cast<int>(bench.range(0)), 50, Law::line);
  for (auto _ : bench) move_elements(rope.state, 1e-9, 0, static_cast<std::ptrdiff_t>(rope.state.size()));
  set_ns(bench, "ns/element", rope.elements());
}
BENCHMARK(Motion)->Arg(7)->Arg(91);

// Contact with viscosity, bonds with damping.
void AllForces(benchmark::State& bench, Law law, Interaction::Precision precision) {
  const Rope rope(static_cast<int>(bench.range(0)), 50, law, precision, 20);
  ForceEngine engine;
  Forces forces(rope.state.size());
  for (auto _ : bench) engine.compute(rope.topology, rope.in, rope.list, rope.state, forces);
  set_ns(bench, "ns/element", rope.elements());
  bench.counters["pairs"] = static_cast<double>(rope.list.pairs()) / rope.elements();
}
BENCHMARK_CAPTURE(AllForces, line_mixed, Law::line, Interaction::Precision::mixed)->Arg(7)->Arg(91);
BENCHMARK_CAPTURE(AllForces, line_full, Law::line, Interaction::Precision::full)->Arg(7)->Arg(91);
BENCHMARK_CAPTURE(AllForces, paper_mixed, Law::paper, Interaction::Precision::mixed)->Arg(7)->Arg(91);
BENCHMARK_CAPTURE(AllForces, paper_full, Law::paper, Interaction::Precision::full)->Arg(7)->Arg(91);

// A slice of a rope of 91 tubes as a rank of several computes it: a part of the elements of each tube is its own,
// and four more at each end are copies (mdem/lammps/README.md has what follows for many ranks).
void SliceOfARope(benchmark::State& bench) {
  constexpr int tubes = 91, copies = 4;
  const int own = static_cast<int>(bench.range(0)), all = own + 2 * copies;
  Rope rope(tubes, all, Law::line, Interaction::Precision::mixed, 20);
  std::vector<int> number;
  std::vector<char> owned;
  for (int i = 0; i < tubes * all; ++i) {
    number.push_back(i);
    owned.push_back(i % all >= copies && i % all < copies + own);
  }
  const Topology slice = part_of_scene(rope.topology, number, owned);
  rope.list.build(slice, rope.state);
  ForceEngine engine;
  Forces forces(rope.state.size());
  for (auto _ : bench) engine.compute(slice, rope.in, rope.list, rope.state, forces);
  set_ns(bench, "ns/own", tubes * own);
}
BENCHMARK(SliceOfARope)->Arg(1)->Arg(5)->Arg(10)->Arg(25)->Arg(50)->Arg(100)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace ropewalk::bench
