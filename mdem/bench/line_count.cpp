#include "bench/line_count.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "sim/contact/line/engine.hpp"

namespace ropewalk {
namespace {

constexpr int none = -1;

bool wide(const std::string& instructions) {
  return instructions.rfind("AVX3", 0) == 0 || instructions.rfind("AVX10", 0) == 0;
}

struct Counter {
  const Topology& topology;
  const Interaction& in;
  const State& state;
  const LineList& list;
  double moved, turned;  // as in LineKernelInput
  int lanes;
  std::vector<PairSum<double>> sums;  // of each pair of types

  Vector3 axis(int i) const { return axis_of(state.orientation[static_cast<std::size_t>(i)]); }
  Vector3 place(int i) const { return state.position[static_cast<std::size_t>(i)]; }
  void add_vectors(int nodes, int times, RadialCount& count) const {
    const int vectors = (nodes + lanes - 1) / lanes * times;
    count.vectors += vectors;
    count.evaluations += vectors * lanes;
  }

  // Nodes first .. first + nodes - 1 from those of element j on.
  void add_row(const LineContact& law, int i, int j, int first, int nodes, int sum, RadialCount& count) const {
    const int on_i = law.sum_nodes_i(sum), on_j = law.sum_nodes_j(sum);
    count.nodes += nodes;
    add_vectors(nodes, on_i, count);
    for (int m = first; m < first + nodes; ++m) {
      const int at = j + m / on_j;
      const Vector3 d = place(at) + line_node(m % on_j, on_j, law.length_j) * axis(at) - place(i);
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

  std::size_t pair(int i, int type_j) const {
    return static_cast<std::size_t>(topology.tube_type[topology.tube_of(i)]) * topology.types.size() +
           static_cast<std::size_t>(type_j);
  }

  // As in the kernel: rows of consecutive elements that take the same sum, and the others one by one.
  void add_run(int i, const LineRun& run, RadialCount& count) const {
    const std::size_t of = pair(i, run.type);
    const LineContact& law = in.line[of];
    const TubeEnds ends = topology.ends_of(i, topology.tube_of(i));
    const double known_until = static_cast<double>(std::max(run.even, run.crossing));
    const bool known = turned < known_until, ended = run.begins || run.ends || ends.any();
    const bool has_row = list.nodes(Rows::all, topology.tube_of(run.element_begin), run.type) > 0;
    int began = 0, sum = none;  // the row that is being made
    const auto finish = [&](int end) {
      if (sum == none) return;
      const LineRun::Nodes& nodes = run.of(law.sparse.thins_j(sum) ? Rows::sparse : Rows::all);
      const int each = law.sum_nodes_j(sum), from = std::max<int>(nodes.from, began * each),
                to = std::min(nodes.from + nodes.count, end * each);
      if (from < to) add_row(law, i, run.element_begin, from, to - from, sum, count);
    };
    for (int m = 0; m < run.elements; ++m) {
      const int j = run.element_begin + m;
      const Vector3 apart = place(j) - place(i);
      const SumShare w = law.sparse.share(axis(i).dot(axis(j)));
      const int last = w.first + (w.value < 1 ? 1 : 0);
      const bool met = known || sums[of].reach.near(last, ended, apart, axis(i), axis(j));
      const bool row =
          met && last == w.first && !fades(law.sparse, last, ends, run) && (has_row || law.sparse.thins_j(last));
      if (met && !row) {
        count.pairs += 1;
        for (int t = w.first; t <= last; ++t) add_pairs(law, i, sums[of].pairs(t, ends, run.tube_ends()), j, count);
      }
      const int takes = row ? w.first : none;
      if (takes != sum) {
        finish(m);
        began = m, sum = takes;
      }
    }
    finish(run.elements);
  }

  // A row that stands for the runs of a block, as element i meets it.
  void add_block_run(int i, const LineChunk& chunk, const BlockRun& run, RadialCount& count) const {
    const LineContact& law = in.line[pair(i, run.row.type)];
    const TouchedPart& part = chunk.parts[static_cast<std::size_t>(run.row.part)];
    const TouchedPart::Row& row = part.row[static_cast<int>(law.sparse.thins_j(0) ? Rows::sparse : Rows::all)];
    add_row(law, i, part.begin, run.row.at - row.first(part.begin), run.row.count, 0, count);
  }

  // Whether what is out of reach for now begins by `beyond`.
  bool in_reach(float beyond, RadialCount& count) const {
    const bool reached = may_be_in_reach(beyond, moved);
    (reached ? count.runs : count.skipped) += 1;
    return reached;
  }

  void add(int i, RadialCount& count) const {
    const auto& chunks = list.chunks();
    const LineChunk& chunk = *std::find_if(chunks.begin(), chunks.end(), [&](const auto& c) {
      return std::any_of(c.own.begin(), c.own.end(), [&](const Segment& s) { return i >= s.begin && i < s.end; });
    });
    for (const ElementRun& end : chunk.end_runs)
      if (end.element == i && in_reach(list.run(end.run).beyond, count)) add_run(i, list.run(end.run), count);
    const auto block = std::find_if(chunk.blocks.begin(), chunk.blocks.end(),
                                    [&](const LineBlock& b) { return i >= b.first && i < b.first + b.elements; });
    if (block == chunk.blocks.end()) return;
    const int own = i - block->first;
    for (int k = block->begin; k < block->end; ++k) {
      const BlockRun& run = chunk.runs[static_cast<std::size_t>(k)];
      const bool even = turned < static_cast<double>(run.even);
      if (even ? run.of != BlockRun::both && run.of != own : run.run[own] == BlockRun::none) continue;
      if (!in_reach(run.beyond, count)) continue;
      even ? add_block_run(i, chunk, run, count) : add_run(i, list.run(run.run[own]), count);
    }
  }
};

// A place among `count`, by the golden ratio now here, now there: samples at equal distances would all lie at the
// same few places of their tubes, where these are a multiple of it long.
std::int64_t within(std::int64_t k, std::int64_t count) {
  constexpr double golden = 0.61803398874989485;
  const double turns = static_cast<double>(k) * golden;
  return static_cast<std::int64_t>((turns - std::floor(turns)) * static_cast<double>(count));
}

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
  const int bytes = wide(best) ? 64 : best == "AVX2" ? 32 : 16;
  return bytes / (precision == Interaction::Precision::mixed ? 4 : 8);
}

int radial_operations(Interaction::Precision precision) {
  const int polynomial = precision == Interaction::Precision::full ? FullTable::operations
                         : wide(instruction_sets().front())        ? MixedTable::operations
                                                                   : decltype(MixedTable::pieces)::operations;
  return 3 + 5 + polynomial + 1 + 12;
}

RadialCount count_radial(const Topology& topology, const Interaction& in, const State& state,
                         const NeighbourList& neighbours, const LineList& list, int most) {
  RadialCount sum, out;
  if (in.line.empty()) return out;
  Counter counter{
      topology, in, state, list, 2 * neighbours.displacement(), neighbours.turn(), radial_lanes(in.precision), {}};
  for (const LineContact& law : in.line) counter.sums.emplace_back(law);
  const std::int64_t n = topology.elements(), samples = std::min<std::int64_t>(n, most);
  for (std::int64_t k = 0; k < samples; ++k) {
    const std::int64_t from = n * k / samples, until = n * (k + 1) / samples;
    counter.add(static_cast<int>(from + within(k, until - from)), sum);
  }
  out.add(sum, 1.0 / static_cast<double>(samples));
  return out;
}

}  // namespace ropewalk
