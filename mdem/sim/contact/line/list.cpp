#include "sim/contact/line/list.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>

#include "sim/threads/scratch.hpp"

namespace ropewalk {
namespace {

// Squared distance of a point from the nodes' part of element i's axis.
double distance2(const Vector3& from_centre, const Vector3& axis, double half) {
  const double along = std::min(std::max(from_centre.dot(axis), -half), half);
  return (from_centre - along * axis).squaredNorm();
}

// One number for a type, whatever its partners.
void check_nodes(const Topology& topology, const Interaction& in) {
  const std::size_t types = topology.types.size();
  for (std::size_t a = 0; a < types; ++a)
    for (std::size_t b = 0; b < types; ++b) {
      const LineContact &as_i = in.line[a * types + b], &as_j = in.line[b * types + a];
      if (as_i.nodes_i != in.line[a * types].nodes_i || as_j.nodes_j != in.line[a * types].nodes_i ||
          as_i.sparse.sum[0].j != in.line[0].sparse.sum[0].j)
        throw std::invalid_argument("a tube type has one number of nodes towards all others");
    }
}

double angle(double cos2) { return std::acos(std::sqrt(std::min(cos2, 1.0))); }

// Element i of one tube before elements of another one.
struct Side {
  const Topology& topology;
  const Interaction& in;
  const NeighbourList& list;
  double even_until, crossing_from;  // rad: to this angle the first sum holds, and from this one the last
  int i, tube_i, tube_j;
  bool all_rows_wanted = false;  // by a run whose elements are not nearly parallel

  const LineContact& law() const { return in.line[in.line_index(topology, tube_i, tube_j)]; }
  Vector3 place(int j) const { return list.reference()[static_cast<std::size_t>(j)]; }
  Vector3 axis(int j) const { return list.reference_axis()[static_cast<std::size_t>(j)]; }
  double to_node2(int j, int l, int count) const {
    const LineContact& k = law();
    return distance2(place(j) - place(i) + line_node(l, count, k.length_j) * axis(j), axis(i),
                     0.5 * k.length_i * (1 - 1.0 / k.nodes_i));
  }

  // Those of the nodes 0 .. elements * count behind `first` that are within reach, looked for from both ends.
  LineRun::Nodes nodes_in_reach(int first, int elements, int count, double reach2) const {
    const auto near = [&](int m) { return to_node2(first + m / count, m % count, count) < reach2; };
    int from = 0, to = elements * count;
    while (from < to && !near(from)) ++from;
    while (from < to && !near(to - 1)) --to;
    return {static_cast<short>(from), static_cast<short>(to - from)};
  }

  // No node of element j is nearer than this. Exact but for the places of single nodes where the two are parallel.
  double nearest(int j) const {
    const LineContact& k = law();
    const Vector3 apart = place(j) - place(i), own = axis(i);
    const double along = apart.dot(own), cosine = own.dot(axis(j)),
                 half_i = 0.5 * k.length_i * (1 - 1.0 / k.nodes_i),
                 half_j = 0.5 * k.length_j * (1 - 1.0 / k.nodes_j);
    const auto at_least = [](double x) { return std::max(x, 0.0); };
    const double beside = at_least(std::sqrt(at_least(apart.squaredNorm() - along * along)) -
                                   half_j * std::sqrt(at_least(1 - cosine * cosine))),
                 ahead = at_least(std::fabs(along) - half_i - half_j * std::fabs(cosine));
    return std::sqrt(beside * beside + ahead * ahead);
  }

  // How far out of reach all nodes of first .. last are; less than zero where one may be within the cutoff.
  float beyond(int first, int last) const {
    double least = nearest((first + last) / 2);  // most often the nearest
    for (int j = first; j <= last && least > law().density.cutoff(); ++j) least = std::min(least, nearest(j));
    return static_cast<float>(least - law().density.cutoff() - 1e-6);
  }

  // What element i can reach of first .. last before the list is built again.
  LineRun trimmed(int first, int last) {
    const LineContact& k = law();
    LineRun run;
    run.type = static_cast<short>(topology.tube_type[tube_j]);
    run.part = tube_j;  // for now
    run.element_begin = first;
    run.begins = first == topology.tube_begin[tube_j];
    run.ends = last + 1 == topology.tube_begin[tube_j + 1];
    find_nodes(first, last, run);
    if (run.elements > 0) {
      run.beyond = beyond(run.element_begin, run.element_begin + run.elements - 1);
      run.fading = fades(k.sparse, 0, topology.ends_of(i, tube_i), run);
      find_angles(run);
    }
    find_damped(first, last, run);
    return run;
  }

  void find_nodes(int first, int last, LineRun& run) const {
    const LineContact& k = law();
    const double reach = k.density.cutoff() + list.skin;
    while (first <= last && nearest(first) > reach) ++first;
    while (first <= last && nearest(last) > reach) --last;
    const int counts[row_kinds] = {k.nodes_j, k.sparse.sum[0].j};
    int from = last + 1, to = first;  // elements with nodes within reach
    for (int kind = 0; kind < row_kinds; ++kind) {
      const int count = counts[kind];
      if (count == 0) continue;
      LineRun::Nodes& nodes = run.nodes[kind] = nodes_in_reach(first, last + 1 - first, count, reach * reach);
      if (nodes.count == 0) continue;
      from = std::min(from, first + nodes.from / count);
      to = std::max(to, first + (nodes.from + nodes.count - 1) / count + 1);
    }
    if (from >= to) return;
    run.element_begin = from;
    run.elements = static_cast<std::int8_t>(to - from);
    for (int kind = 0; kind < row_kinds; ++kind)
      run.nodes[kind].from = static_cast<short>(run.nodes[kind].from - (from - first) * counts[kind]);
  }

  // Which sums the run takes, and until when it is sure to take the first alone, or the last: both elements may
  // turn, by 1.01 times the change of an axis at most where that is small.
  void find_angles(LineRun& run) {
    const SparseNodes& sparse = law().sparse;
    const Vector3 own = axis(i);
    double smallest = 1, largest = 0;
    for (int j = run.element_begin; j < run.element_begin + run.elements; ++j) {
      const double cosine = own.dot(axis(j));
      smallest = std::min(smallest, cosine * cosine);
      largest = std::max(largest, cosine * cosine);
    }
    all_rows_wanted |= !sparse.thins_j(sparse.last_of(smallest));
    if (sparse.count == 0) {
      run.even = std::numeric_limits<float>::infinity();
      return;
    }
    const auto room = [](double until) { return static_cast<float>(until / 2.02 - 1e-6); };
    run.even = room(even_until - angle(smallest));
    if (largest < sparse.sum[static_cast<std::size_t>(sparse.count - 1)].from_cos2)
      run.crossing = room(angle(largest) - crossing_from);
  }

  void find_damped(int first, int last, LineRun& run) const {
    if (!in.damped_contact()) return;
    const double reach = in.damping.contact.outer + list.skin;
    const auto near = [&](int j) { return (place(j) - place(i)).squaredNorm() < reach * reach; };
    while (first <= last && !near(first)) ++first;
    while (first <= last && !near(last)) --last;
    run.damped_from = static_cast<std::int8_t>(first - run.element_begin);
    run.damped = static_cast<std::int8_t>(last + 1 - first);
  }

  // Consecutive elements; the first and the last one of the tube are runs of their own.
  void add(int first, int last, std::vector<LineRun>& runs) {
    const int begin = topology.tube_begin[tube_j], end = topology.tube_begin[tube_j + 1];
    for (int from = first; from <= last;) {
      int to = std::min(last, from + LineRun::longest - 1);
      if (from == begin) to = from;
      if (to == end - 1 && from < to) --to;
      const LineRun run = trimmed(from, to);
      if (run.elements > 0 || run.damped > 0) runs.push_back(run);
      from = to + 1;
    }
  }
};

}  // namespace

// Found by one thread.
struct LineList::Part {
  std::vector<LineRun> runs;
  std::vector<std::size_t> count;  // runs of each element
  std::vector<int> dense;          // tubes whose rows of all nodes are wanted

  void find(const Topology& topology, const Interaction& in, const NeighbourList& list, int tube) {
    const SparseNodes& sparse = in.line[0].sparse;
    const std::size_t last = static_cast<std::size_t>(std::max(sparse.count, 1)) - 1;
    const double even_until = angle(sparse.sum[0].full_cos2), crossing_from = angle(sparse.sum[last].from_cos2);
    for (int i = topology.tube_begin[tube]; i < topology.tube_begin[tube + 1]; ++i) {
      const std::size_t before = runs.size();
      for (const PairRun& run : list.runs(i))
        for_tubes_of(topology, run, [&](int tube_j, int begin, int end) {
          Side side{topology, in, list, even_until, crossing_from, i, tube, tube_j};
          side.add(begin, end - 1, runs);
          if (side.all_rows_wanted && (dense.empty() || dense.back() != tube_j)) dense.push_back(tube_j);
        });
      count.push_back(runs.size() - before);
    }
  }
};

namespace {

// ns as measured once in a rope of 91 tubes (bench, `rope-91x50`). Of runs whose elements are not all nearly
// parallel, which take several sums, or that over all nodes: 80 to 200 do about as well for `rope-91x50-twisted`.
constexpr double element_cost = 50, run_out_of_reach = 1.5, build_of_an_element = 2500;
double cost_in_reach(const LineRun& run, bool at_end) {
  constexpr double of_a_row = 22, of_other_sums = 55, pair_at_an_end = 31;
  if (at_end || run.begins || run.ends) return pair_at_an_end * run.elements;
  return run.even > 0 ? of_a_row : of_other_sums;
}

}  // namespace

// Of element i.
double LineList::cost(const Topology& topology, int i, int tube) const {
  const bool at_end = topology.ends_of(i, tube).any();
  double sum = element_cost;
  for (const LineRun* run = begin(i); run != end(i); ++run)
    sum += run->elements == 0 || run->beyond > 0 ? run_out_of_reach : cost_in_reach(*run, at_end);
  return sum;
}

double LineList::best_skin(const Topology& topology, double listed, long steps) const {
  constexpr double ratio = 1.25, least = 0.04, most = 0.4, worth = 0.98;
  struct AtTheRim {
    double beyond, in_reach;
  };
  std::vector<AtTheRim> rim;
  double always = 0;  // cost of the runs that are within reach with any skin
  for (int t = 0; t < topology.tubes(); ++t)
    for (int i = topology.tube_begin[t]; i < topology.tube_begin[t + 1]; ++i)
      for (const LineRun* run = begin(i); run != end(i); ++run) {
        if (run->elements == 0) continue;
        const double beyond = static_cast<double>(run->beyond),
                     cost = cost_in_reach(*run, topology.ends_of(i, t).any());
        if (beyond > 0)
          rim.push_back({beyond, cost});
        else
          always += run_out_of_reach + cost;
      }
  const double wear = listed / static_cast<double>(std::max(steps, 1L));  // by how much distances change in a step
  // For a step, over the life of a list, and of building it. What lies farther out than this list is taken to be as
  // much as in its outermost part.
  const auto step_cost = [&](double skin) {
    const double farther = std::max(skin - listed, 0.0);
    const auto over_a_life = [&](double beyond, double in_reach) {
      // Distances change at a steady pace, up to the skin.
      return beyond < skin ? run_out_of_reach + (1 - beyond / skin) * in_reach : 0.0;
    };
    double sum = always + build_of_an_element * topology.elements() * wear / skin;
    for (const AtTheRim& run : rim) {
      sum += over_a_life(run.beyond, run.in_reach);
      if (run.beyond > listed - farther) sum += over_a_life(run.beyond + farther, run.in_reach);
    }
    return sum;
  };
  double best = listed, lowest = worth * step_cost(listed);
  for (double skin = std::min(listed * ratio, most); skin >= least; skin /= ratio) {
    const double cost = step_cost(skin);
    if (cost < lowest) best = skin, lowest = cost;
  }
  return best;
}

// Of equal cost, whatever the threads: the cut belongs to the list.
void LineList::cut_into_chunks(const Topology& topology, const Vec3Array& position, std::size_t count) {
  std::vector<double> costs;
  costs.reserve(static_cast<std::size_t>(topology.elements()));
  for (int t = 0; t < topology.tubes(); ++t)
    for (int i = topology.tube_begin[t]; i < topology.tube_begin[t + 1]; ++i) costs.push_back(cost(topology, i, t));
  chunks_.assign(count, LineChunk{});
  const CutBy first = position.size() > large_scene ? CutBy::place : CutBy::index;
  auto tiles = cut_into_tiles(topology, position, costs, static_cast<int>(count), first);
  for (std::size_t c = 0; c < count; ++c) chunks_[c].own = std::move(tiles[c]);
}

namespace {

struct Elements {
  int begin = 0, end = 0;
  void take(const Elements& o) {
    begin = std::min(begin, o.begin);
    end = std::max(end, o.end);
  }
};

// Those within reach of the contact or of its viscosity.
Elements reached(const LineRun& run) {
  const int from = run.element_begin + run.damped_from;
  Elements all{run.element_begin, run.element_begin + run.elements};
  if (run.elements == 0) all = {from, from + run.damped};
  if (run.damped > 0) all.take({from, from + run.damped});
  return all;
}

}  // namespace

template <class Work>
void LineList::for_runs_of(const LineChunk& chunk, const Work& work) {
  for (const Segment& own : chunk.own)
    for (std::size_t k = begin_[static_cast<std::size_t>(own.begin)]; k < begin_[static_cast<std::size_t>(own.end)];
         ++k)
      work(run_[k]);
}

// The parts of tubes that a chunk acts on: its own elements that have neighbours, and these. Its runs, which had
// their tubes, get their parts.
void LineList::find_parts(const Topology& topology, LineChunk& chunk) {
  constexpr int gap = 4;  // elements in between that are cheaper to have in the buffers than to leave out
  std::vector<Elements> hull(static_cast<std::size_t>(topology.tubes()), {topology.elements(), 0});
  const auto each = [&](const auto& take) {  // all ranges of elements acted on
    for (const Segment& own : chunk.own)
      for (int i = own.begin; i < own.end; ++i) {
        if (begin(i) == end(i)) continue;
        take(own.tube, Elements{i, i + 1});
        for (const LineRun* run = begin(i); run != end(i); ++run) take(run->part, reached(*run));
      }
  };
  std::vector<int> tubes;
  each([&](int tube, const Elements& e) {
    Elements& all = hull[static_cast<std::size_t>(tube)];
    if (all.begin >= all.end) tubes.push_back(tube);
    all.take(e);
  });
  std::sort(tubes.begin(), tubes.end());
  // Of the elements of all hulls, one after another: whether they are acted on, later their parts.
  std::vector<int> shift(static_cast<std::size_t>(topology.tubes()));
  int total = 0;
  for (int t : tubes) {
    const Elements& all = hull[static_cast<std::size_t>(t)];
    shift[static_cast<std::size_t>(t)] = total - all.begin;
    total += all.end - all.begin;
  }
  constexpr int none = -1, some = 0;
  std::vector<int> part(static_cast<std::size_t>(total), none);
  each([&](int tube, const Elements& e) {
    const auto from = part.begin() + shift[static_cast<std::size_t>(tube)];
    std::fill(from + e.begin, from + e.end, some);
  });
  for (int t : tubes) {
    const Elements& all = hull[static_cast<std::size_t>(t)];
    const auto of = part.begin() + shift[static_cast<std::size_t>(t)];
    for (int i = all.begin, last = all.begin - gap - 2; i < all.end; ++i) {
      if (of[i] == none) continue;
      if (i - last > gap + 1) chunk.parts.push_back({t, i, i, 0, {}, std::numeric_limits<float>::infinity()});
      last = i;
      chunk.parts.back().end = i + 1;
      of[i] = static_cast<int>(chunk.parts.size()) - 1;
    }
  }
  const auto part_of = [&](int tube, int element) {
    return part[static_cast<std::size_t>(shift[static_cast<std::size_t>(tube)] + element)];
  };
  for_runs_of(chunk, [&](LineRun& run) {
    run.part = part_of(run.part, reached(run).begin);
    float& beyond = chunk.parts[static_cast<std::size_t>(run.part)].beyond;
    beyond = run.damped > 0 ? 0 : std::min(beyond, run.beyond);
  });
  for (const Segment& own : chunk.own)
    for (int i = own.begin; i < own.end; ++i)
      if (begin(i) != end(i)) chunk.parts[static_cast<std::size_t>(part_of(own.tube, i))].beyond = 0;
  chunk.elements = DampedBlock::most;  // room for vectors that begin before the first one
  for (TouchedPart& p : chunk.parts) {
    p.element_shift = chunk.elements - p.begin;
    chunk.elements += p.end - p.begin;
  }
}

// In the rows of nodes.
void LineList::place_parts(const Topology& topology, LineChunk& chunk) const {
  for (TouchedPart& p : chunk.parts)
    for (const Rows kind : {Rows::all, Rows::sparse}) {
      TouchedPart::Row& row = p.row[static_cast<int>(kind)];
      int& placed = chunk.nodes[static_cast<int>(kind)];
      row.per_element = nodes(kind, p.tube, topology.tube_type[p.tube]);
      row.origin = placed - p.begin * row.per_element;
      placed += (p.end - p.begin) * row.per_element;
    }
}

void LineList::count_rows(LineChunk& chunk) const {
  for (const Segment& own : chunk.own)
    for (int i = own.begin; i < own.end; ++i) {
      int rows = 0;
      for (const LineRun* run = begin(i); run != end(i); ++run) rows += run->elements;
      chunk.most_rows = std::max(chunk.most_rows, rows);
    }
}

namespace {

// Vectors of the widest kind.
int vectors_of(const NodeRow& row) { return (row.count + NodeRow::pad - 1) / NodeRow::pad; }

NodeRow both(const NodeRow& a, const NodeRow& b) {
  NodeRow out = a.at <= b.at ? a : b;
  out.count = static_cast<short>(std::max(a.at + a.count, b.at + b.count) - out.at);
  return out;
}

bool on_one_part(const LineRun& a, const LineRun& b) {
  return b.elements > 0 && !b.fading && a.part == b.part && a.begins == b.begins && a.ends == b.ends;
}

}  // namespace

// The runs of consecutive elements on the same tube become one row where that takes no more vectors than the longer
// of them.
void LineList::add_block(const LineBlock& of, int tube, Rows kind, LineChunk& chunk) const {
  const int first = of.first, elements = of.elements;
  LineBlock block{first, of.at, elements, static_cast<int>(chunk.runs.size()), 0};
  const auto part_of = [&](const LineRun& run) -> const TouchedPart& {
    return chunk.parts[static_cast<std::size_t>(run.part)];
  };
  const auto row_of = [&](const LineRun& run) -> NodeRow {
    return {part_of(run).first_node(run, kind), run.of(kind).count, run.type, run.part};
  };
  const auto add = [&](const LineRun& run, const NodeRow& row) -> BlockRun& {
    chunk.runs.push_back({row, run.beyond, run.even, {BlockRun::none, BlockRun::none}, BlockRun::both});
    return chunk.runs.back();
  };
  const auto own_tube = [&](const LineRun& run) { return part_of(run).tube == tube; };
  const auto runs_on = [&](const LineRun& part, int element) {
    return std::count_if(begin(element), end(element), [&](const LineRun& run) { return on_one_part(part, run); });
  };
  const auto joined = [&](const LineRun& own) -> const LineRun* {
    if (elements == 1 || own_tube(own) || runs_on(own, first) != 1 || runs_on(own, first + 1) != 1) return nullptr;
    const LineRun* other =
        std::find_if(begin(first + 1), end(first + 1), [&](const LineRun& run) { return on_one_part(own, run); });
    const NodeRow a = row_of(own), b = row_of(*other);
    return vectors_of(both(a, b)) <= std::max(vectors_of(a), vectors_of(b)) ? other : nullptr;
  };
  std::vector<const LineRun*> taken;  // of the second element, by one of the first
  for (int e = 0; e < elements; ++e)
    for (const LineRun* run = begin(first + e); run != end(first + e); ++run) {
      if (run->elements == 0 || run->fading || std::find(taken.begin(), taken.end(), run) != taken.end()) continue;
      const LineRun* other = e == 0 ? joined(*run) : nullptr;
      BlockRun& out = add(*run, other ? both(row_of(*run), row_of(*other)) : row_of(*run));
      out.run[e] = index(*run);
      if (!other) {
        if (elements == 2 && (own_tube(*run) || runs_on(*run, first + 1 - e) > 0)) out.of = e;
        continue;
      }
      taken.push_back(other);
      out.run[1] = index(*other);
      out.beyond = std::min(run->beyond, other->beyond);
      out.even = std::min(run->even, other->even);
    }
  block.end = static_cast<int>(chunk.runs.size());
  if (block.begin < block.end) chunk.blocks.push_back(block);
}

void LineList::add_end_run(const Topology& topology, int i, const TouchedPart& own, const LineRun& run,
                           LineChunk& chunk) const {
  const int at = i + own.element_shift;
  chunk.end_runs.push_back({i, at, index(run)});
  chunk.even = std::min(chunk.even, run.even);
  const int types = static_cast<int>(topology.types.size());
  const PairKind kind{topology.tube_type[own.tube] * types + run.type, 0, topology.ends_of(i, own.tube),
                      run.tube_ends(), false};
  AlikePairs& same = of_kind(kind, chunk.end_pairs);
  const int shift = chunk.parts[static_cast<std::size_t>(run.part)].element_shift;
  for (int j = run.element_begin; j < run.element_begin + run.elements; ++j)
    same.pairs.push_back({i, j, at, j + shift, run.beyond});
}

// Of the elements of a chunk, whose parts have been placed. Not across a tube's own runs: which of its elements
// meet depends on how far apart they are along it.
void LineList::make_blocks(const Topology& topology, const Interaction& in, LineChunk& chunk) const {
  const Rows kind = in.line[0].sparse.thins_j(0) ? Rows::sparse : Rows::all;
  chunk.even = std::numeric_limits<float>::infinity();
  PartOf part_of(chunk);
  for (const Segment& own : chunk.own) {
    const int tube = own.tube;
    const auto joins = [&](int i) { return i < own.end && begin(i) != end(i) && !topology.ends_of(i, tube).any(); };
    for (int i = own.begin; i < own.end;) {
      if (begin(i) == end(i)) {
        ++i;
        continue;
      }
      const TouchedPart& part = part_of(i);
      const int elements = joins(i) && joins(i + 1) ? 2 : 1;
      add_block({i, i + part.element_shift, elements, 0, 0}, tube, kind, chunk);
      for (int last = i + elements; i < last; ++i)
        for (const LineRun* run = begin(i); run != end(i); ++run)
          if (run->elements > 0 && run->fading) add_end_run(topology, i, part, *run, chunk);
    }
  }
  for (AlikePairs& of : chunk.end_pairs) {
    std::stable_sort(of.pairs.begin(), of.pairs.end(),
                     [](const AlikePairs::Pair& a, const AlikePairs::Pair& b) { return a.beyond < b.beyond; });
    of.pairs.shrink_to_fit();
  }
  chunk.blocks.shrink_to_fit();
  chunk.runs.shrink_to_fit();
  chunk.end_runs.shrink_to_fit();
}

void LineList::list_damped(LineChunk& chunk) const {
  DampedBlocks blocks;
  PartOf part_of(chunk);
  std::vector<char> damped(chunk.parts.size(), 0);
  for (const Segment& of : chunk.own)
    for (int i = of.begin; i < of.end; ++i)
      for (const LineRun* run = begin(i); run != end(i); ++run) {
        if (run->damped == 0) continue;
        TouchedRange own = part_of(i).elements();
        own.end = std::min(own.end, of.end);
        const int from = run->element_begin + run->damped_from;
        blocks.add(i, own, from, from + run->damped, chunk.parts[static_cast<std::size_t>(run->part)].elements());
        damped[static_cast<std::size_t>(run->part)] = 1;
        damped[static_cast<std::size_t>(&part_of(i) - chunk.parts.data())] = 1;
      }
  chunk.damped = blocks.take();
  for (std::size_t p = 0; p < damped.size(); ++p)
    if (damped[p]) chunk.damped_parts.push_back(chunk.parts[p].elements());
}

void LineList::build(const Topology& topology, const Interaction& in, const NeighbourList& list) {
  check_nodes(topology, in);
  unit_ = list.coordinate_unit();
  const bool parallel = topology.elements() > static_cast<int>(parallel_from);
  const int tubes = topology.tubes(), parts = std::min(tubes, 64);
  std::vector<Part> found(static_cast<std::size_t>(parts));
#pragma omp parallel for schedule(dynamic, 1) if (parallel)
  for (int part = 0; part < parts; ++part)
    for (int t = static_cast<int>(static_cast<std::int64_t>(tubes) * part / parts);
         t < static_cast<int>(static_cast<std::int64_t>(tubes) * (part + 1) / parts); ++t)
      found[static_cast<std::size_t>(part)].find(topology, in, list, t);

  std::size_t total = 0;
  for (const Part& part : found) total += part.runs.size();
  run_.clear();
  make_room(run_, total);
  begin_.assign(1, 0);
  begin_.reserve(static_cast<std::size_t>(topology.elements()) + 1);
  dense_.assign(static_cast<std::size_t>(tubes), 0);
  for (const Part& part : found) {
    run_.insert(run_.end(), part.runs.begin(), part.runs.end());
    for (std::size_t count : part.count) begin_.push_back(begin_.back() + count);
    for (int t : part.dense) dense_[static_cast<std::size_t>(t)] = 1;
  }
  split_runs_ = static_cast<std::size_t>(std::count_if(run_.begin(), run_.end(), [](const LineRun& run) {
    return run.elements > 0 && run.beyond <= 0 && run.even <= 0 && run.crossing <= 0;
  }));
  for (auto& of_types : per_element_) of_types.clear();
  for (std::size_t a = 0; a < topology.types.size(); ++a) {
    per_element_[static_cast<int>(Rows::all)].push_back(in.line[a * topology.types.size()].nodes_i);
    per_element_[static_cast<int>(Rows::sparse)].push_back(in.line[0].sparse.sum[0].j);
  }

  cut_into_chunks(topology, list.reference(), list.chunks().size());
#pragma omp parallel for schedule(dynamic, 1) if (parallel)
  for (std::size_t c = 0; c < chunks_.size(); ++c)
    if (!chunks_[c].own.empty()) {
      find_parts(topology, chunks_[c]);
      place_parts(topology, chunks_[c]);
      count_rows(chunks_[c]);
      make_blocks(topology, in, chunks_[c]);
      if (in.damped_contact()) list_damped(chunks_[c]);
    }
  most_rows_ = most_elements_ = 0;
  for (int& most : most_nodes_) most = 0;
  for (const LineChunk& chunk : chunks_) {
    most_rows_ = std::max(most_rows_, chunk.most_rows);
    most_elements_ = std::max(most_elements_, chunk.elements);
    for (int kind = 0; kind < row_kinds; ++kind) most_nodes_[kind] = std::max(most_nodes_[kind], chunk.nodes[kind]);
  }
}

std::size_t LineList::bytes() const {
  std::size_t total = run_.capacity() * sizeof(LineRun) + begin_.capacity() * sizeof(std::size_t);
  for (const LineChunk& chunk : chunks_) {
    total += chunk.own.capacity() * sizeof(Segment) + chunk.parts.capacity() * sizeof(TouchedPart) +
             chunk.blocks.capacity() * sizeof(LineBlock) + chunk.runs.capacity() * sizeof(BlockRun) +
             chunk.end_runs.capacity() * sizeof(ElementRun) + chunk.damped.capacity() * sizeof(DampedBlock) +
             chunk.damped_parts.capacity() * sizeof(TouchedRange);
    for (const AlikePairs& of : chunk.end_pairs) total += of.pairs.capacity() * sizeof(AlikePairs::Pair);
  }
  return total;
}

}  // namespace ropewalk
