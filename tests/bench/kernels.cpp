// Micro-benchmarks of the forms and of a whole force evaluation. Build with the preset `bench`.
#include <benchmark/benchmark.h>
#include <omp.h>

#include "sim/forces.hpp"
#include "unit/support.hpp"

namespace ropewalk {
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
  const Frame<double> i = frame_of(random.orientation()), j = frame_of(test::turn(random.direction(), 0.1));
  const Vector3 separation(0.1, 0, 1.35);
  for (auto _ : bench)
    benchmark::DoNotOptimize(bond_energy_and_gradient(k, test::element_length, separation, i, j));
}
BENCHMARK(Bond);

// Arguments: elements per tube of a 7-tube bundle, contact viscosity.
void AllForces(benchmark::State& bench) {
  omp_set_num_threads(1);
  Topology topology = test::published_topology();
  const State state = test::disordered_bundle(topology, 7, static_cast<int>(bench.range(0)), 1.75, 0.02, 3);
  Interaction in;
  in.paper = test::published_contact();
  in.damping.contact = {static_cast<double>(bench.range(1)), 1.713, 2.57};
  NeighbourList list(in, 0.15);
  list.build(topology, state);
  ForceEngine engine;
  Forces forces(state.size());
  for (auto _ : bench) engine.compute(topology, in, list, state, forces);
  bench.counters["ns_per_pair"] =
      benchmark::Counter(static_cast<double>(list.pairs()) * 1e-9,
                         benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK(AllForces)->Args({100, 0})->Args({100, 20});

}  // namespace
}  // namespace ropewalk
