#include "sim/contact/line/list.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "sim/threads/for_each.hpp"
#include "sim/threads/scratch.hpp"

namespace ropewalk {
namespace {

// Squared distance of a point from the nodes' part of element i's axis.
double distance2(const Vector3& from_centre, const Vector3& axis, double half) {
  const double along = std::min(std::max(from_centre.dot(axis), -half), half);
  return (from_centre - along * axis).squaredNorm();
}

double at_least_zero(double x) { return std::max(x, 0.0); }

void check_nodes(const Topology& topology, const Interaction& in) {
  const LineLaw& law = line_law_of(in);
  const auto types = static_cast<int>(topology.types.size());
  for (int a = 0; a < types; ++a)
    for (int b = 0; b < types; ++b)
      if (law.of({a, b}).nodes_i != law.of({a, 0}).nodes_i || law.of({b, a}).nodes_j != law.of({a, 0}).nodes_i)
        throw std::invalid_argument("a tube type has one number of nodes towards all others");
}

// Half the distance of an element's first and last nodes, nm.
double half_of_nodes(double length, int nodes) { return 0.5 * length * (1 - 1.0 / nodes); }

// Element i of one tube before elements of another one, at the positions of the list.
struct SpanFinder {
  const Topology& topology;
  const Interaction& in;
  const NeighbourList& list;
  double near_reach;  // reach of other work on pairs, nm; 0: there is none
  int i, tube_i, tube_j;
  const LineContact& law;
  double half_i, half_j;

  SpanFinder(const Topology& t, const Interaction& interaction, const NeighbourList& neighbours, double reach,
             int element, int own_tube, int other_tube)
      : topology(t),
        in(interaction),
        list(neighbours),
        near_reach(reach),
        i(element),
        tube_i(own_tube),
        tube_j(other_tube),
        law(line_law_of(interaction).of({t.tube_type[own_tube], t.tube_type[other_tube]})),
        half_i(half_of_nodes(law.length_i, law.nodes_i)),
        half_j(half_of_nodes(law.length_j, law.nodes_j)) {}

  Vector3 position(int j) const { return list.reference()[static_cast<std::size_t>(j)]; }
  Vector3 axis(int j) const { return list.reference_axis()[static_cast<std::size_t>(j)]; }

  // No node of element j is nearer than this (nm). Exact but for the places of single nodes where the two are
  // parallel.
  double nearest(int j) const {
    const Vector3 apart = position(j) - position(i), own = axis(i);
    const double along = apart.dot(own), cosine = own.dot(axis(j));
    const double beside = at_least_zero(std::sqrt(at_least_zero(apart.squaredNorm() - along * along)) -
                                        half_j * std::sqrt(at_least_zero(1 - cosine * cosine))),
                 ahead = at_least_zero(std::fabs(along) - half_i - half_j * std::fabs(cosine));
    return std::sqrt(beside * beside + ahead * ahead);
  }

  double gap_to_cutoff(int first, int last) const {
    double least = nearest((first + last) / 2);  // most often the nearest
    for (int j = first; j <= last && least > law.density.cutoff(); ++j) least = std::min(least, nearest(j));
    return least - law.density.cutoff() - 1e-6;
  }

  void find_nodes(int first, int last, NeighbourSpan& span) const {
    const double reach = law.density.cutoff() + list.skin;
    while (first <= last && nearest(first) > reach) ++first;
    while (first <= last && nearest(last) > reach) --last;
    const int count = law.nodes_j;
    const auto near = [&](int m) {
      const int j = first + m / count;
      const Vector3 node = position(j) + line_node(m % count, count, law.length_j) * axis(j);
      return distance2(node - position(i), axis(i), half_i) < reach * reach;
    };
    int from = 0, to = (last + 1 - first) * count;
    while (from < to && !near(from)) ++from;
    while (from < to && !near(to - 1)) --to;
    if (from >= to) return;
    span.first = first + from / count;
    span.elements = static_cast<std::int8_t>(first + (to - 1) / count + 1 - span.first);
    span.node_from = static_cast<short>(from % count);
    span.nodes = static_cast<short>(to - from);
    span.gap_to_cutoff = static_cast<float>(gap_to_cutoff(span.first, span.first + span.elements - 1));
  }

  void find_near(int first, int last, NeighbourSpan& span) const {
    if (!(near_reach > 0)) return;
    const double reach = near_reach + list.skin;
    const auto near = [&](int j) { return (position(j) - position(i)).squaredNorm() < reach * reach; };
    while (first <= last && !near(first)) ++first;
    while (first <= last && !near(last)) --last;
    span.near_from = static_cast<std::int8_t>(first - span.first);
    span.near = static_cast<std::int8_t>(last + 1 - first);
  }

  // Adds the elements of first .. last that element i can reach.
  void add(int first, int last, std::vector<NeighbourSpan>& spans) const {
    for (int to; first <= last; first = to + 1) {
      to = std::min(last, first + NeighbourSpan::longest - 1);
      NeighbourSpan span;
      span.type = static_cast<short>(topology.tube_type[tube_j]);
      span.range = tube_j;  // until find_ranges
      span.first = first;
      find_nodes(first, to, span);
      find_near(first, to, span);
      if (span.elements > 0 || span.near > 0) spans.push_back(span);
    }
  }
};

}  // namespace

// Work of one thread.
struct LineList::Found {
  std::vector<NeighbourSpan> spans;
  std::vector<std::size_t> count;  // count of each element

  void find(const Topology& topology, const Interaction& in, const NeighbourList& list, double near_reach,
            int tube) {
    for (int i = topology.tube_begin[tube]; i < topology.tube_begin[tube + 1]; ++i) {
      const std::size_t before = spans.size();
      for (const ElementSpan& span : list.spans(i))
        for_tubes_of(topology, span, [&](int tube_j, int begin, int end) {
          SpanFinder(topology, in, list, near_reach, i, tube, tube_j).add(begin, end - 1, spans);
        });
      count.push_back(spans.size() - before);
    }
  }
};

namespace {

// ns as measured once in a rope of 91 tubes (bench, rope-91x50).
constexpr double element_cost = 50, cost_out_of_reach = 1.5, build_of_an_element = 2500;
double cost_in_reach(const NeighbourSpan& span) { return 5 + 1.2 * span.nodes; }

}  // namespace

double LineList::cost(int element) const {
  double sum = element_cost;
  for (const NeighbourSpan& span : spans(element))
    sum += span.may_be_in_reach(0) ? cost_in_reach(span) : cost_out_of_reach;
  return sum;
}

double LineList::best_skin(const Topology& topology, double listed, long steps) const {
  constexpr double ratio = 1.25, least = 0.04, most = 0.4, worth = 0.98;
  struct AtTheRim {
    double beyond, in_reach;
  };
  std::vector<AtTheRim> rim;
  double always = 0;  // cost of the spans that are within reach with any skin
  for (const NeighbourSpan& span : spans_) {
    if (span.elements == 0) continue;
    const double beyond = static_cast<double>(span.gap_to_cutoff), cost = cost_in_reach(span);
    if (beyond > 0)
      rim.push_back({beyond, cost});
    else
      always += cost_out_of_reach + cost;
  }
  const double wear = listed / static_cast<double>(std::max(steps, 1L));  // change of distances in a step
  // For a step, over the life of a list, and of building it. What lies farther out than this list is taken to be as
  // much as in its outermost part.
  const auto step_cost = [&](double skin) {
    const double farther = std::max(skin - listed, 0.0);
    const auto over_a_life = [&](double beyond, double in_reach) {
      // Distances change at a steady pace, up to the skin.
      return beyond < skin ? cost_out_of_reach + (1 - beyond / skin) * in_reach : 0.0;
    };
    double sum = always + build_of_an_element * topology.elements() * wear / skin;
    for (const AtTheRim& span : rim) {
      sum += over_a_life(span.beyond, span.in_reach);
      if (span.beyond > listed - farther) sum += over_a_life(span.beyond + farther, span.in_reach);
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

// Cuts into chunks of equal cost, whatever the threads: the cut belongs to the list.
void LineList::cut_into_chunks(const Topology& topology, const Vec3Array& position, std::size_t count) {
  std::vector<double> costs;
  costs.reserve(static_cast<std::size_t>(topology.elements()));
  for (int i = 0; i < topology.elements(); ++i) costs.push_back(cost(i));
  chunks_.assign(count, LineChunk{});
  const CutBy first = position.size() > large_scene ? CutBy::position : CutBy::index;
  auto tiles = cut_into_tiles(topology, position, costs, static_cast<int>(count), first);
  for (std::size_t c = 0; c < count; ++c) chunks_[c].own = std::move(tiles[c]);
}

namespace {

struct Elements {
  int begin = 0, end = 0;
  void include(const Elements& o) {
    begin = std::min(begin, o.begin);
    end = std::max(end, o.end);
  }
};

// The elements that the contact or other work on pairs may reach.
Elements reached(const NeighbourSpan& span) {
  const Elements near{span.first + span.near_from, span.first + span.near_from + span.near};
  if (span.elements == 0) return near;
  Elements all{span.first, span.first + span.elements};
  if (span.near > 0) all.include(near);
  return all;
}

}  // namespace

// Finds the ranges that a chunk writes to: its own elements that have neighbours, and these. Its spans, which had
// their tubes, get their ranges.
void LineList::find_ranges(const Topology& topology, LineChunk& chunk) {
  constexpr int gap = 4;  // elements in between that are cheaper to have in the buffers than to leave out
  std::vector<Elements> hull(static_cast<std::size_t>(topology.tubes()), {topology.elements(), 0});
  const auto each = [&](const auto& work) {  // with all ranges of elements acted on
    for (const Segment& own : chunk.own)
      for (int i = own.begin; i < own.end; ++i) {
        const auto of = spans(i);
        if (of.begin() == of.end()) continue;
        work(own.tube, Elements{i, i + 1});
        for (const NeighbourSpan& span : of) work(span.range, reached(span));
      }
  };
  std::vector<int> tubes;
  each([&](int tube, const Elements& e) {
    Elements& all = hull[static_cast<std::size_t>(tube)];
    if (all.begin >= all.end) tubes.push_back(tube);
    all.include(e);
  });
  std::sort(tubes.begin(), tubes.end());
  // For the elements of all hulls, one after another: whether they are acted on, later their ranges.
  std::vector<int> shift(static_cast<std::size_t>(topology.tubes()));
  int total = 0;
  for (int t : tubes) {
    const Elements& all = hull[static_cast<std::size_t>(t)];
    shift[static_cast<std::size_t>(t)] = total - all.begin;
    total += all.end - all.begin;
  }
  constexpr int none = -1, some = 0;
  std::vector<int> range(static_cast<std::size_t>(total), none);
  each([&](int tube, const Elements& e) {
    const auto from = range.begin() + shift[static_cast<std::size_t>(tube)];
    std::fill(from + e.begin, from + e.end, some);
  });
  for (int t : tubes) {
    const Elements& all = hull[static_cast<std::size_t>(t)];
    const auto of = range.begin() + shift[static_cast<std::size_t>(t)];
    for (int i = all.begin, last = all.begin - gap - 2; i < all.end; ++i) {
      if (of[i] == none) continue;
      if (i - last > gap + 1) chunk.ranges.push_back({t, i, i, 0, 0, nodes_per_element(topology.tube_type[t])});
      last = i;
      chunk.ranges.back().end = i + 1;
      of[i] = static_cast<int>(chunk.ranges.size()) - 1;
    }
  }
  for (const Segment& own : chunk.own)
    for (int i = own.begin; i < own.end; ++i) {
      int vectors = 0;
      for (std::size_t k = begin_[static_cast<std::size_t>(i)]; k < begin_[static_cast<std::size_t>(i) + 1]; ++k) {
        NeighbourSpan& span = spans_[k];
        span.range =
            range[static_cast<std::size_t>(shift[static_cast<std::size_t>(span.range)] + reached(span).begin)];
        vectors += (span.nodes + 15) / 16;
      }
      chunk.vectors = std::max(chunk.vectors, vectors);
    }
  chunk.elements = room_before;
  for (WrittenRange& r : chunk.ranges) {
    r.element_shift = chunk.elements - r.begin;
    r.node_origin = chunk.nodes - r.begin * r.nodes_per_element;
    chunk.elements += r.end - r.begin;
    chunk.nodes += (r.end - r.begin) * r.nodes_per_element;
  }
}

namespace {

class LinePairs : public ChunkPairs {
 public:
  LinePairs(const LineList& list, const LineChunk& chunk) : list_(list), chunk_(chunk) {}

  int entries() const override { return chunk_.elements; }
  void each(const std::function<void(const NearElements&)>& visit) const override {
    RangeOf range_of(chunk_);
    for (const Segment& of : chunk_.own)
      for (int i = of.begin; i < of.end; ++i)
        for (const NeighbourSpan& span : list_.spans(i)) {
          if (span.near == 0) continue;
          const int from = span.first + span.near_from;
          visit({i, range_of(i).elements(), of.end, from, from + span.near,
                 chunk_.ranges[static_cast<std::size_t>(span.range)].elements()});
        }
  }

 private:
  const LineList& list_;
  const LineChunk& chunk_;
};

}  // namespace

void LineList::build(const Topology& topology, const Interaction& in, const NeighbourList& list, PairWork* pairs) {
  check_nodes(topology, in);
  unit_ = list.coordinate_unit();
  const bool parallel = topology.elements() > static_cast<int>(parallel_from);
  const int tubes = topology.tubes(), parts = std::min(tubes, 64);
  const double near_reach = pairs ? pairs->reach() : 0;
  std::vector<Found> found(static_cast<std::size_t>(parts));
  for_each_uneven(parts, 1, parallel, [&](int part) {
    for (int t = static_cast<int>(static_cast<std::int64_t>(tubes) * part / parts);
         t < static_cast<int>(static_cast<std::int64_t>(tubes) * (part + 1) / parts); ++t)
      found[static_cast<std::size_t>(part)].find(topology, in, list, near_reach, t);
  });

  std::size_t total = 0;
  for (const Found& part : found) total += part.spans.size();
  spans_.clear();
  reserve_tightly(spans_, total);
  begin_.assign(1, 0);
  begin_.reserve(static_cast<std::size_t>(topology.elements()) + 1);
  for (const Found& part : found) {
    spans_.insert(spans_.end(), part.spans.begin(), part.spans.end());
    for (std::size_t count : part.count) begin_.push_back(begin_.back() + count);
  }
  nodes_per_element_.clear();
  for (int a = 0; a < static_cast<int>(topology.types.size()); ++a)
    nodes_per_element_.push_back(line_law_of(in).of({a, 0}).nodes_i);

  cut_into_chunks(topology, list.reference(), list.chunks().size());
  if (pairs) pairs->start(chunks_.size());
  for_each_uneven(chunks_.size(), std::size_t{1}, parallel, [&](std::size_t c) {
    if (chunks_[c].own.empty()) return;
    find_ranges(topology, chunks_[c]);
    if (pairs) pairs->list(c, LinePairs(*this, chunks_[c]));
  });
  largest_ = {};
  for (const LineChunk& chunk : chunks_)
    for (int LineChunk::*size : {&LineChunk::elements, &LineChunk::nodes, &LineChunk::vectors})
      largest_.*size = std::max(largest_.*size, chunk.*size);
}

std::size_t LineList::bytes() const {
  std::size_t total = spans_.capacity() * sizeof(NeighbourSpan) + begin_.capacity() * sizeof(std::size_t);
  for (const LineChunk& chunk : chunks_)
    total += chunk.own.capacity() * sizeof(Segment) + chunk.ranges.capacity() * sizeof(WrittenRange);
  return total;
}

}  // namespace ropewalk
