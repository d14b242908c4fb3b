#include "sim/line_count.hpp"

#include <algorithm>

#include "sim/line_engine.hpp"

namespace ropewalk {
namespace {

struct Counter {
  const Topology& topology;
  const Interaction& in;
  const State& state;
  const LineList& list;
  double moved;
  int lanes;
  std::vector<PairSum<double>> sums;  // of each pair of types

  Vector3 axis(int i) const { return axis_of(state.orientation[static_cast<std::size_t>(i)]); }
  Vector3 place(int i) const { return state.position[static_cast<std::size_t>(i)]; }
  void add_vectors(int nodes, int times, RadialCount& count) const {
    const int vectors = (nodes + lanes - 1) / lanes * times;
    count.vectors += vectors;
    count.evaluations += vectors * lanes;
  }

  void add_row(const LineContact& law, int i, const LineRun& run, int sum, RadialCount& count) const {
    const LineRun::Nodes& nodes = run.of(law.sparse.thins_j(sum) ? Rows::sparse : Rows::all);
    const int on_i = law.sum_nodes_i(sum), on_j = law.sum_nodes_j(sum);
    count.nodes += nodes.count;
    add_vectors(nodes.count, on_i, count);
    for (int m = nodes.from; m < nodes.from + nodes.count; ++m) {
      const int j = run.element_begin + m / on_j;
      const Vector3 d = place(j) + line_node(m % on_j, on_j, law.length_j) * axis(j) - place(i);
      for (int k = 0; k < on_i; ++k)
        count.useful += (d - line_node(k, on_i, law.length_i) * axis(i)).norm() < law.density.cutoff();
    }
  }

  // In lanes that are all full, but for the last ones of a chunk.
  void add_pairs(const LineContact& law, int i, const NodePairs<double>& of, int j, RadialCount& count) const {
    count.vectors += static_cast<double>(of.weight.size()) / lanes;
    count.evaluations += static_cast<double>(of.weight.size());
    for (std::size_t m = 0; m < of.weight.size(); ++m) {
      const Vector3 d = place(j) + of.j[m] * axis(j) - place(i) - of.i[m] * axis(i);
      count.useful += d.norm() < law.density.cutoff();
    }
  }

  void add(int i, RadialCount& count) const {
    const int tube = topology.tube_of(i);
    const TubeEnds ends = topology.ends_of(i, tube);
    for (const LineRun* run = list.begin(i); run != list.end(i); ++run) {
      if (run->elements == 0) continue;
      if (static_cast<double>(run->beyond) > moved) {
        count.skipped += 1;
        continue;
      }
      count.runs += 1;
      const std::size_t pair = static_cast<std::size_t>(topology.tube_type[tube]) * topology.types.size() +
                               static_cast<std::size_t>(run->type);
      const LineContact& law = in.line[pair];
      double smallest = 1, largest = 0;
      for (int j = run->element_begin; j < run->element_begin + run->elements; ++j) {
        const double c = axis(i).dot(axis(j));
        smallest = std::min(smallest, c * c);
        largest = std::max(largest, c * c);
      }
      const bool has_row = list.layout(Rows::all).has_row(topology.tube_of(run->element_begin));
      const RunSum sum = run_sum(law, ends, *run, has_row, smallest, largest);
      if (sum.kind == RunSum::rows) {
        add_row(law, i, *run, sum.first, count);
        continue;
      }
      for (int j = run->element_begin; j < run->element_begin + run->elements; ++j) {
        const SumShare w = law.sparse.share(axis(i).dot(axis(j)));
        count.pairs += 1;
        for (int t = w.first; t <= w.first + (w.value < 1 ? 1 : 0); ++t)
          add_pairs(law, i, sums[pair].pairs(t, ends, run->tube_ends()), j, count);
      }
    }
  }
};

}  // namespace

void RadialCount::add(const RadialCount& other, double share) {
  runs += share * other.runs;
  skipped += share * other.skipped;
  pairs += share * other.pairs;
  nodes += share * other.nodes;
  vectors += share * other.vectors;
  evaluations += share * other.evaluations;
  useful += share * other.useful;
}

int radial_lanes(Interaction::Precision precision) {
  const std::string best = instruction_sets().front();
  if (best == "SCALAR") return 1;
  const bool wide = best.rfind("AVX3", 0) == 0 || best.rfind("AVX10", 0) == 0;
  const int bytes = wide ? 64 : best == "AVX2" ? 32 : 16;
  return bytes / (precision == Interaction::Precision::mixed ? 4 : 8);
}

RadialCount count_radial(const Topology& topology, const Interaction& in, const State& state, const LineList& list,
                         double moved, int most) {
  RadialCount sum, out;
  if (in.line.empty()) return out;
  Counter counter{topology, in, state, list, moved, radial_lanes(in.precision), {}};
  for (const LineContact& law : in.line) counter.sums.emplace_back(law);
  const int n = topology.elements(), step = std::max(1, n / most);
  int sampled = 0;
  for (int i = 0; i < n; i += step, ++sampled) counter.add(i, sum);
  out.add(sum, 1.0 / sampled);
  return out;
}

}  // namespace ropewalk
