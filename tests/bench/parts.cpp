// What a force evaluation consists of besides contact. It contains forces.cpp, whose loops no header shows: what is
// measured is what is shipped.
#include "bench/support.hpp"
#include "sim/forces.cpp"

namespace ropewalk::bench {
namespace {

void Frames(benchmark::State& bench) {
  const Rope rope(static_cast<int>(bench.range(0)), 50, Law::line);
  FrameArray frames;
  frames.resize(rope.state.size());
  for (auto _ : bench) {
    frames_of(rope.state.orientation, 0, static_cast<std::ptrdiff_t>(rope.state.size()), frames);
    benchmark::ClobberMemory();
  }
  set_ns(bench, "ns/element", rope.elements());
}
BENCHMARK(Frames)->Arg(7)->Arg(91);

// Bonds of all tubes, into arrays of their own, and then onto the elements.
struct Bonds {
  const Rope rope;
  FrameArray frames;
  BondArray bonds;
  Vec3Array force, torque;

  explicit Bonds(int tubes) : rope(tubes, 50, Law::line, Interaction::Precision::mixed, 20) {
    frames.resize(rope.state.size());
    frames_of(rope.state.orientation, 0, static_cast<std::ptrdiff_t>(rope.state.size()), frames);
    for (Vec3Array* v : {&bonds.force_j, &bonds.torque_i, &bonds.torque_j, &force, &torque})
      v->resize(rope.state.size());
  }
  template <class F>
  void each_tube(F f) const {
    const Topology& t = rope.topology;
    for (int k = 0; k < t.tubes(); ++k) f(t.type_of(k), t.tube_begin[k], t.tube_begin[k + 1]);
  }
};

void BondForces(benchmark::State& bench) {
  Bonds b(static_cast<int>(bench.range(0)));
  double slips = 1;
  for (auto _ : bench)
    b.each_tube([&](const TubeType& type, std::ptrdiff_t begin, std::ptrdiff_t end) {
      benchmark::DoNotOptimize(bond_forces(type, b.rope.state.position, b.frames, begin, end - 1, b.bonds, slips));
    });
  set_ns(bench, "ns/element", b.rope.elements());
}
BENCHMARK(BondForces)->Arg(7)->Arg(91);

void BondDampingForces(benchmark::State& bench) {
  Bonds b(static_cast<int>(bench.range(0)));
  for (auto _ : bench)
    b.each_tube([&](const TubeType& type, std::ptrdiff_t begin, std::ptrdiff_t end) {
      benchmark::DoNotOptimize(bond_damping(type, b.rope.in.damping.bond, b.rope.state, begin, end - 1, b.bonds));
    });
  set_ns(bench, "ns/element", b.rope.elements());
}
BENCHMARK(BondDampingForces)->Arg(7)->Arg(91);

void BondSums(benchmark::State& bench) {
  Bonds b(static_cast<int>(bench.range(0)));
  for (auto _ : bench) {
    b.each_tube([&](const TubeType&, std::ptrdiff_t from, std::ptrdiff_t to) {
      add_bonds(b.bonds.force_j.x, -1, b.bonds.force_j.x, from, to, b.force.x);
      add_bonds(b.bonds.force_j.y, -1, b.bonds.force_j.y, from, to, b.force.y);
      add_bonds(b.bonds.force_j.z, -1, b.bonds.force_j.z, from, to, b.force.z);
      add_bonds(b.bonds.torque_i.x, 1, b.bonds.torque_j.x, from, to, b.torque.x);
      add_bonds(b.bonds.torque_i.y, 1, b.bonds.torque_j.y, from, to, b.torque.y);
      add_bonds(b.bonds.torque_i.z, 1, b.bonds.torque_j.z, from, to, b.torque.z);
    });
    benchmark::ClobberMemory();
  }
  set_ns(bench, "ns/element", b.rope.elements());
}
BENCHMARK(BondSums)->Arg(7)->Arg(91);

}  // namespace
}  // namespace ropewalk::bench
