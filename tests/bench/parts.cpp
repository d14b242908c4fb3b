// The parts of a force evaluation besides contact. It contains bonds.cpp, whose loops no header shows: the measured
// code is the shipped code.
#include "bench/support.hpp"
#include "sim/forces/bonds.cpp"

namespace ropewalk::bench {
namespace {

void Frames(benchmark::State& bench) {
  const Rope rope(static_cast<int>(bench.range(0)), 50, Law::line);
  FrameArray frames;
  frames.resize(rope.state.size());
  for (auto _ : bench) {
    ROPEWALK_IN_USE(frames_of)
    (rope.state.orientation, 0, 0, static_cast<std::ptrdiff_t>(rope.state.size()), frames);
    benchmark::ClobberMemory();
  }
  set_ns(bench, "ns/element", rope.elements());
}
BENCHMARK(Frames)->Arg(7)->Arg(91);

// Bonds of all tubes, with the frames of the first one: the tubes of a rope are alike.
struct Bonds {
  const Rope rope;
  TubeBonds work;
  Forces out;

  explicit Bonds(int tubes)
      : rope(tubes, 50, Law::line, Interaction::Precision::mixed, 20), out(rope.state.size()) {
    work.resize(static_cast<std::size_t>(rope.topology.length_of(0)));
    ROPEWALK_IN_USE(frames_of)(rope.state.orientation, 0, 0, rope.topology.length_of(0), work.frames);
  }
  template <class F>
  void each_tube(F f) const {
    const Topology& t = rope.topology;
    for (int k = 0; k < t.tubes(); ++k) f(t.type_of(k), BondRange{t.tube_begin[k], 0, t.length_of(k) - 1});
  }
};

void BondForces(benchmark::State& bench) {
  Bonds b(static_cast<int>(bench.range(0)));
  double slips = 1;
  for (auto _ : bench)
    b.each_tube([&](const TubeType& type, const BondRange& bonds) {
      benchmark::DoNotOptimize(
          ROPEWALK_IN_USE(harmonic_forces)(type, b.rope.state.position, b.work.frames, bonds, b.work.bonds, slips));
    });
  set_ns(bench, "ns/element", b.rope.elements());
}
BENCHMARK(BondForces)->Arg(7)->Arg(91);

void BondDampingForces(benchmark::State& bench) {
  Bonds b(static_cast<int>(bench.range(0)));
  for (auto _ : bench)
    b.each_tube([&](const TubeType& type, const BondRange& bonds) {
      benchmark::DoNotOptimize(
          ROPEWALK_IN_USE(bond_damping)(type, b.rope.in.damping.bond, b.rope.state, bonds, b.work.bonds));
    });
  set_ns(bench, "ns/element", b.rope.elements());
}
BENCHMARK(BondDampingForces)->Arg(7)->Arg(91);

// All that bonds take: frames, forces, damping and sums.
void AllOfBonds(benchmark::State& bench) {
  Bonds b(static_cast<int>(bench.range(0)));
  const TubeParts parts(b.rope.topology);  // whole tubes: nothing joins them
  const BondInput bonded{b.rope.topology, b.rope.in.damping.bond, b.rope.state};
  for (auto _ : bench) {
    for (int k = 0; k < parts.count(); ++k)
      benchmark::DoNotOptimize(compute_bonds(bonded, parts[k], nullptr, nullptr, rows_of(b.out)));
    benchmark::ClobberMemory();
  }
  set_ns(bench, "ns/element", b.rope.elements());
}
BENCHMARK(AllOfBonds)->Arg(7)->Arg(91);

}  // namespace
}  // namespace ropewalk::bench
