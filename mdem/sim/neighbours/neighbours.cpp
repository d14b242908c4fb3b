#include "sim/neighbours/neighbours.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <utility>

#include "model/contract.hpp"
#include "sim/neighbours/cell_grid.hpp"
#include "sim/neighbours/excluded.hpp"
#include "sim/threads/for_each.hpp"
#include "sim/threads/scratch.hpp"

namespace ropewalk {
namespace {

// Appends the spans of one element's neighbours, in rising order; a span of an earlier element is never made
// longer.
void append_spans(const int* number, std::size_t count, std::vector<ElementSpan>& spans) {
  for (std::size_t k = 0; k < count; ++k) {
    if (k > 0 && number[k] == spans.back().end)
      ++spans.back().end;
    else
      spans.push_back({number[k], number[k] + 1});
  }
}

}  // namespace

bool NeighbourList::update(const Topology& topology, const State& state) {
  constexpr std::ptrdiff_t block = cached_elements;
  Change all;
  const auto n = static_cast<std::ptrdiff_t>(state.size());
  for (std::ptrdiff_t i = 0; i < n; i += block) all = both(all, change(state, i, std::min(i + block, n)));
  if (!stale(all)) return false;
  build(topology, state);
  return true;
}

bool NeighbourList::stale(const Change& change) {
  displacement_ = since_.bound(change, within(), lever);
  return !(displacement_ <= 0.5 * skin);
}

Change NeighbourList::change(const State& state, std::ptrdiff_t begin, std::ptrdiff_t end) const {
  return since_.change(state, lever, begin, end);
}

void NeighbourList::build(const Topology& topology, const State& state) {
  begin(topology, state);
  find_pairs(topology);
}

void NeighbourList::build(const Topology& topology, Vec3Array position, Vec3Array axis) {
  begin(topology, std::move(position), std::move(axis));
  find_pairs(topology);
}

void NeighbourList::begin(const Topology& topology, const State& state) {
  Vec3Array axis(state.size());
  for (std::size_t i = 0; i < state.size(); ++i) axis.set(i, axis_of(state.orientation[i]));
  begin(topology, state.position, std::move(axis));
}

void NeighbourList::begin(const Topology& topology, Vec3Array position, Vec3Array axis) {
  ROPEWALK_EXPECTS(cutoff >= 0 && skin >= 0 && lever >= 0);
  static std::atomic<long> stamps{0};
  stamp_ = ++stamps;
  displacement_ = 0;
  since_.start(topology, std::move(position), std::move(axis), others);
  ++builds_;
  begin_.clear();
  spans_.clear();
  pairs_ = 0;
}

void NeighbourList::find_pairs(const Topology& topology) {
  const Vec3Array& p = reference();
  const int n = static_cast<int>(p.size());
  const double reach = cutoff + skin;
  begin_.assign(static_cast<std::size_t>(n) + 1, 0);
  spans_.clear();
  pairs_ = 0;
  if (cutoff > 0) {
    const CellGrid grid(p, reach);
    const std::vector<int> last = last_excluded(topology, excluded_arc);

    constexpr int parts = 64;
    std::vector<std::vector<ElementSpan>> found(parts);
    std::vector<std::size_t> pairs_of_part(parts);
    for_each_uneven(parts, 1, p.size() > parallel_from, [&](int part) {
      const int from = static_cast<int>(static_cast<std::int64_t>(n) * part / parts);
      const int to = static_cast<int>(static_cast<std::int64_t>(n) * (part + 1) / parts);
      auto& list = found[static_cast<std::size_t>(part)];
      std::vector<int> near;
      std::size_t pairs = 0;
      for (int i = from; i < to; ++i) {
        const auto si = static_cast<std::size_t>(i);
        if (!topology.owns(i)) continue;
        const std::size_t count = grid.find(i, last[si], near);
        const auto end = near.begin() + static_cast<std::ptrdiff_t>(count);
        std::sort(near.begin(), end);
        const std::size_t before = list.size();
        append_spans(near.data(), count, list);
        begin_[si + 1] = list.size() - before;
        pairs += count;
      }
      pairs_of_part[static_cast<std::size_t>(part)] = pairs;
    });
    std::size_t total = 0;
    for (const auto& list : found) total += list.size();
    reserve_tightly(spans_, total);
    for (const auto& list : found) spans_.insert(spans_.end(), list.begin(), list.end());
    for (std::size_t pairs : pairs_of_part) pairs_ += pairs;
    for (std::size_t i = 1; i < begin_.size(); ++i) begin_[i] += begin_[i - 1];
    ROPEWALK_ENSURES(begin_.back() == spans_.size());
  }
  cut_into_chunks(n);
}

double NeighbourList::coordinate_unit() const {
  const double period = 32 * (cutoff + 2 * lever);
  return std::exp2(std::max(8.0, std::ceil(std::log2(period))) - 32);
}

// The chunks do not depend on the number of threads. Where tubes with distant numbers cross, the buffers of the
// chunks overlap widely. Clearing and adding many such buffers would cost as much as the contact, so that fewer are
// made.
void NeighbourList::cut_into_chunks(int n) {
  constexpr int fewest = 16;         // enough for as many threads
  constexpr double max_overlap = 3;  // buffers for each element
  for (int count = chunk_count(n, whole_ranges);; count = std::max(fewest, count / 2)) {
    cut_into_chunks(n, count);
    if (!whole_ranges) return;
    double written = 0;
    for (const Chunk& c : chunks_) written += c.written_end - c.written_begin;
    if (count <= fewest || written <= max_overlap * n) return;
  }
}

// Chunks of equal numbers of pairs.
void NeighbourList::cut_into_chunks(int n, int count) {
  chunks_.assign(static_cast<std::size_t>(count), Chunk{});
  int from = 0;
  std::size_t before = 0;  // pairs of the elements before `to`
  for (int k = 0; k < count; ++k) {
    Chunk& chunk = chunks_[static_cast<std::size_t>(k)];
    const std::size_t target = pairs() * static_cast<std::size_t>(k + 1) / static_cast<std::size_t>(count);
    int to = from;
    if (k + 1 == count) {
      to = n;
    } else {
      while (to < n && before < target) before += pairs(to++);
    }
    chunk.begin = from;
    chunk.end = to;
    chunk.written_begin = from;
    chunk.written_end = to;
    for (int i = from; i < to; ++i)
      for (const ElementSpan& span : spans(i)) chunk.written_end = std::max(chunk.written_end, span.end);
    from = to;
  }
  ROPEWALK_ENSURES(from == n);
}

}  // namespace ropewalk
