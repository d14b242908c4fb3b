// Scenes and counters that the benchmarks share.
#pragma once

#include <benchmark/benchmark.h>
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>
#include <vector>

#include "sim/contact/contact_law.hpp"
#include "sim/contact/line/law.hpp"
#include "sim/contact/paper/law.hpp"
#include "sim/forces/forces.hpp"
#include "unit/support.hpp"

namespace ropewalk::bench {

enum class Law { paper, line };

// The line law between (10,10) tubes, with as many nodes as a scene would choose.
inline LineContact graphite_contact() {
  const LineDensity density = test::line_density();
  const double length = test::element_length;
  const int nodes = line_nodes(length, line_parallel_well(density).distance, density.contact);
  return {density, length, length, nodes, nodes};
}

// Places of tubes one spacing apart, shell by shell.
inline std::vector<std::pair<double, double>> hexagonal(int tubes) {
  std::vector<std::pair<double, double>> places;
  for (int shell = 0; static_cast<int>(places.size()) < tubes; ++shell)
    for (int a = -shell; a <= shell; ++a)
      for (int b = -shell; b <= shell; ++b)
        if (std::max({std::abs(a), std::abs(b), std::abs(a + b)}) == shell)
          places.emplace_back(a + 0.5 * b, 0.5 * std::sqrt(3.0) * b);
  places.resize(static_cast<std::size_t>(tubes));
  return places;
}

// A straight hexagonal rope of (10,10) tubes whose elements are a little out of place and turned, with its list.
// The elements have since moved half as far as the list allows: what runs of the line law are skipped depends on
// it.
struct Rope {
  Topology topology = test::published_topology();
  Interaction in;
  State state;
  Vec3Array axis;
  NeighbourList list;

  Rope(int tubes, int elements, Law law, Interaction::Precision precision = Interaction::Precision::mixed,
       double viscosity = 0, double worn = 0.5)
      : state(static_cast<std::size_t>(tubes * elements)) {
    omp_set_num_threads(1);
    if (law == Law::paper) {
      in.law = paper_law(test::published_contact());
    } else {
      in.law = line_law({graphite_contact()});
    }
    in.precision = precision;
    const double spacing = law == Law::paper ? 1.713 : line_parallel_well(graphite_contact().density).distance;
    in.damping.contact = {viscosity, spacing, 1.5 * spacing};
    in.damping.bond.rate = viscosity > 0 ? 1 : 0;
    place(tubes, elements, spacing);
    list = NeighbourList(in, in.law->default_skin());
    list.build(topology, state);
    for (double& z : state.position.z) z += worn * 0.5 * list.skin;
    list.update(topology, state);
  }

  double elements() const { return static_cast<double>(state.size()); }

 private:
  void place(int tubes, int elements, double spacing) {
    constexpr double disorder = 0.003;  // nm, and rad
    test::Random random(5);
    for (const auto& [x, y] : hexagonal(tubes)) {
      const int begin = topology.elements();
      topology.add_tube(elements);
      for (int e = 0; e < elements; ++e) {
        const auto i = static_cast<std::size_t>(begin + e);
        state.position.set(
            i, Vector3(x * spacing, y * spacing, e * test::element_length) + disorder * random.direction());
        state.orientation.set(i, test::turn(random.direction(), disorder));
      }
    }
    test::set_velocities(topology, 300, state);
    axis.resize(state.size());
    for (std::size_t i = 0; i < state.size(); ++i) axis.set(i, axis_of(state.orientation[i]));
  }
};

// `amount` per iteration: ns each.
inline void set_ns(benchmark::State& bench, const char* name, double amount) {
  bench.counters[name] = benchmark::Counter(
      amount * 1e-9, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

// `amount` per iteration: 1e9 of them per second.
inline void set_giga(benchmark::State& bench, const char* name, double amount) {
  bench.counters[name] = benchmark::Counter(amount * 1e-9, benchmark::Counter::kIsIterationInvariantRate);
}

}  // namespace ropewalk::bench
