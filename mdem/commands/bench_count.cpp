#include "commands/bench_count.hpp"

#include <algorithm>

namespace ropewalk {
namespace {

constexpr int most_sampled = 4000;  // elements

// One element and the runs of its neighbours.
struct Counter {
  const Topology& topology;
  const Interaction& in;
  const State& state;
  const LineList& list;
  double moved;  // nm, as the kernel has it
  int lanes;

  Vector3 axis(int i) const { return axis_of(state.orientation[static_cast<std::size_t>(i)]); }
  Vector3 place(int i) const { return state.position[static_cast<std::size_t>(i)]; }
  const LineContact& law(int i, const LineRun& run) const {
    const auto type_i = static_cast<std::size_t>(topology.tube_type[topology.tube_of(i)]);
    return in.line[type_i * topology.types.size() + static_cast<std::size_t>(run.type)];
  }

  // Whether the sparse sum is taken, and whether the dense one is.
  std::pair<bool, bool> sums(const LineContact& law, const Vector3& n, const LineRun& run) const {
    if (law.sparse_i == 0) return {false, true};
    bool sparse = false, dense = run.begins || run.ends;
    for (int j = run.element_begin; j < run.element_end; ++j) {
      const double share = sparse_weight(n.dot(axis(j))).value;
      sparse |= share > 0;
      dense |= share < 1;
    }
    return {sparse, dense || !sparse};
  }

  // Pairs of `on_i` nodes of the element and the nodes of a run that are closer than the cutoff.
  double close_pairs(const LineContact& law, const Vector3& x, const Vector3& n, const LineRun& run,
                     int on_i) const {
    const double cutoff2 = law.density.cutoff() * law.density.cutoff();
    double pairs = 0;
    for (int node = run.node_begin; node < run.node_end; ++node) {
      const int j = run.element_begin + (node - run.row) / law.nodes_j, l = (node - run.row) % law.nodes_j;
      const Vector3 d = place(j) + line_node(l, law.nodes_j, law.length_j) * axis(j) - x;
      for (int k = 0; k < on_i; ++k) pairs += (d - line_node(k, on_i, law.length_i) * n).squaredNorm() < cutoff2;
    }
    return pairs;
  }

  void add(int i, RadialCount& count) const {
    const Vector3 x = place(i), n = axis(i);
    for (const LineRun* run = list.begin(i); run != list.end(i); ++run) {
      const int nodes = run->node_end - run->node_begin;
      if (static_cast<double>(run->beyond) > moved || nodes <= 0) continue;
      const LineContact& of_pair = law(i, *run);
      const auto [sparse, dense] = sums(of_pair, n, *run);
      count.runs += 1;
      count.nodes += nodes;
      for (const int on_i : {sparse ? of_pair.sparse_i : 0, dense ? of_pair.nodes_i : 0}) {
        count.evaluations += on_i * ((nodes + lanes - 1) / lanes * lanes);
        count.useful += close_pairs(of_pair, x, n, *run, on_i);
      }
    }
  }
};

}  // namespace

void RadialCount::add(const RadialCount& other, double share) {
  runs += share * other.runs;
  nodes += share * other.nodes;
  evaluations += share * other.evaluations;
  useful += share * other.useful;
}

int radial_lanes(Interaction::Precision precision) {
  const std::string best = instruction_sets().front();
  const bool wide = best.rfind("AVX3", 0) == 0 || best.rfind("AVX10", 0) == 0;
  const int bytes = wide ? 64 : best == "AVX2" ? 32 : 16;
  return bytes / (precision == Interaction::Precision::mixed ? 4 : 8);
}

RadialCount count_radial(const Simulation& s) {
  RadialCount sum;
  if (s.interaction().line.empty()) return sum;
  const Counter counter{s.topology(),
                        s.interaction(),
                        s.state(),
                        s.engine().line().list(),
                        2 * s.list().displacement(),
                        radial_lanes(s.interaction().precision)};
  const int n = s.topology().elements(), step = std::max(1, n / most_sampled);
  int sampled = 0;
  for (int i = 0; i < n; i += step, ++sampled) counter.add(i, sum);
  RadialCount out;
  out.add(sum, 1.0 / sampled);
  return out;
}

}  // namespace ropewalk
