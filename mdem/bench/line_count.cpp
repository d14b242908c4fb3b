#include "bench/line_count.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "sim/contact/line/engine.hpp"

namespace ropewalk {
namespace {

struct Counter {
  const Topology& topology;
  const Interaction& in;
  const State& state;
  const LineList& list;
  double moved;  // as in LineKernelInput
  int lanes;

  Vector3 axis(int i) const { return axis_of(state.orientation[static_cast<std::size_t>(i)]); }
  Vector3 position(int i) const { return state.position[static_cast<std::size_t>(i)]; }

  // Returns the number of nodes of a span within reach of element i.
  int add_span(int i, const LineContact& law, const NeighbourSpan& span, RadialCount& count) const {
    const double half = line_node(law.nodes_i - 1, law.nodes_i, law.length_i), cutoff = law.density.cutoff();
    int nodes = 0;
    for (int m = span.node_from; m < span.node_from + span.nodes; ++m) {
      const int j = span.first + m / law.nodes_j;
      const Vector3 d = position(j) + line_node(m % law.nodes_j, law.nodes_j, law.length_j) * axis(j) - position(i);
      const double along = d.dot(axis(i)), nearest = std::min(std::max(along, -half), half);
      nodes += (d - nearest * axis(i)).norm() < cutoff;
      for (int k = 0; k < law.nodes_i; ++k)
        count.useful += (d - line_node(k, law.nodes_i, law.length_i) * axis(i)).norm() < cutoff;
    }
    return nodes;
  }

  void add(int i, RadialCount& count) const {
    const int type = topology.tube_type[topology.tube_of(i)];
    for (const NeighbourSpan& span : list.spans(i)) {
      const LineContact& law = line_law_of(in).of({type, span.type});
      const bool reached = span.may_be_in_reach(moved);
      (reached ? count.spans : count.skipped) += 1;
      const int nodes = reached ? add_span(i, law, span, count) : 0;
      count.nodes += nodes;
      count.evaluations += (nodes + lanes - 1) / lanes * lanes * law.nodes_i;
    }
  }
};

// The k-th number of a low-discrepancy sequence (golden ratio) in 0 .. count - 1. Equidistant samples would hit the
// same few positions along every tube if the tube length were a multiple of the distance.
std::int64_t within(std::int64_t k, std::int64_t count) {
  constexpr double golden = 0.61803398874989485;
  const double turns = static_cast<double>(k) * golden;
  return static_cast<std::int64_t>((turns - std::floor(turns)) * static_cast<double>(count));
}

}  // namespace

void RadialCount::add(const RadialCount& other, double share) {
  spans += share * other.spans;
  skipped += share * other.skipped;
  nodes += share * other.nodes;
  evaluations += share * other.evaluations;
  useful += share * other.useful;
}

int radial_lanes(Interaction::Precision precision) {
  const int bytes = vector_unit_in_use() == VectorUnit::v4 ? 64 : vector_unit_in_use() == VectorUnit::v3 ? 32 : 16;
  return bytes / (precision == Interaction::Precision::mixed ? 4 : 8);
}

int radial_operations(Interaction::Precision precision) {
  const int polynomial = precision == Interaction::Precision::full ? FullTable::operations
                         : vector_unit_in_use() == VectorUnit::v4  ? MixedTable::operations
                                                                   : decltype(MixedTable::pieces)::operations;
  return 3 + polynomial + 3;
}

RadialCount count_radial(const Topology& topology, const Interaction& in, const State& state,
                         const NeighbourList& neighbours, const LineList& list, int most) {
  RadialCount sum, out;
  const Counter counter{topology, in, state, list, 2 * neighbours.displacement(), radial_lanes(in.precision)};
  const std::int64_t n = topology.elements(), samples = std::min<std::int64_t>(n, most);
  for (std::int64_t k = 0; k < samples; ++k) {
    const std::int64_t from = n * k / samples, until = n * (k + 1) / samples;
    counter.add(static_cast<int>(from + within(k, until - from)), sum);
  }
  out.add(sum, 1.0 / static_cast<double>(samples));
  return out;
}

}  // namespace ropewalk
