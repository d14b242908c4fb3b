// The list of the line law's kernel: for every element the spans of consecutive elements of other tubes that may
// come within its reach before the list is built again, and chunks of elements as units of parallel work. No index
// per pair.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "sim/contact/line/law.hpp"
#include "sim/contact/pair_work.hpp"
#include "sim/neighbours/neighbours.hpp"
#include "sim/state/interaction.hpp"
#include "sim/state/tiles.hpp"
#include "sim/threads/span.hpp"

namespace ropewalk {

// Neighbours of one element on another tube, or on another part of its own.
struct NeighbourSpan {
  static constexpr int longest = 64;  // elements

  int first = 0;                   // element
  int range = 0;                   // place in LineChunk::ranges, which the chunk writes to
  float gap_to_cutoff = 0;         // nm: so far outside the cutoff its nearest node was when the list was built
  short node_from = 0, nodes = 0;  // that may come within the cutoff; counted from the first node of `first`
  short type = 0;                  // type of the tube
  std::int8_t elements = 0;        // that may come within the cutoff
  std::int8_t near_from = 0, near = 0;  // elements that other work on pairs may reach, counted from `first`

  // `moved` (nm): by no more have distances shrunk since the list was built.
  bool may_be_in_reach(double moved) const { return elements > 0 && static_cast<double>(gap_to_cutoff) <= moved; }
};
static_assert(sizeof(NeighbourSpan) <= 24 && NeighbourSpan::longest <= INT8_MAX);

// Consecutive elements begin .. end - 1 of a tube that a chunk acts on, and their entries in its buffers.
struct WrittenRange {
  int tube = 0, begin = 0, end = 0;
  int element_shift = 0;                       // element j is entry j + element_shift
  int node_origin = 0, nodes_per_element = 0;  // element j's first node is node node_origin + j nodes_per_element

  BufferRange elements() const { return {begin, end, element_shift}; }
  int first_node(int element) const { return node_origin + element * nodes_per_element; }
};

// Some elements and all that they act on.
struct LineChunk {
  std::vector<Segment> own;          // segments in the order of their elements
  std::vector<WrittenRange> ranges;  // ranges in the order of their elements
  int elements = 0, nodes = 0;       // sizes of its buffers
  int vectors = 0;                   // of 16 nodes, that one of its elements may meet
};

// Finds the ranges that elements of a chunk are in, asked for in rising order.
class RangeOf {
 public:
  explicit RangeOf(const LineChunk& chunk) : range_(chunk.ranges.data()) {}
  const WrittenRange& operator()(int element) {
    while (range_->end <= element) ++range_;
    return *range_;
  }

 private:
  const WrittenRange* range_;
};

// The law of an interaction whose law is known to be a LineLaw.
inline const LineLaw& line_law_of(const Interaction& in) { return static_cast<const LineLaw&>(*in.law); }

class LineList {
 public:
  // Entries of a chunk's buffers before its first element, so that whole vectors can begin there.
  static constexpr int room_before = 16;

  // Builds it from the neighbour list's pairs and the positions at which that list was built, and lists the pairs
  // for `pairs` (or null). Throws std::invalid_argument where a tube type has other numbers of nodes towards
  // different partners.
  void build(const Topology& topology, const Interaction& interaction, const NeighbourList& list, PairWork* pairs);

  Span<NeighbourSpan> spans(int element) const { return entries_of(element, begin_, spans_); }
  std::size_t spans() const { return spans_.size(); }
  int nodes_per_element(int type) const { return nodes_per_element_[static_cast<std::size_t>(type)]; }
  const std::vector<LineChunk>& chunks() const { return chunks_; }
  // The largest of any chunk.
  const LineChunk& largest() const { return largest_; }
  // The skin (nm) that would have cost least, building included, given that a list of skin `listed` lasted `steps`
  // steps. It follows from the list and not from a clock: the same run has the same lists.
  double best_skin(const Topology& topology, double listed, long steps) const;
  // A power of two (nm) that resolves every coordinate in 29 bits.
  double unit() const { return unit_; }
  std::size_t bytes() const;

 private:
  struct Found;
  double cost(int element) const;
  void cut_into_chunks(const Topology& topology, const Vec3Array& position, std::size_t count);
  void find_ranges(const Topology& topology, LineChunk& chunk);

  std::vector<int> nodes_per_element_;  // count for each tube type
  std::vector<NeighbourSpan> spans_;
  std::vector<std::size_t> begin_;  // first span of each element; last: the number of spans
  std::vector<LineChunk> chunks_;
  LineChunk largest_;  // its sizes alone
  double unit_ = 1;
};

}  // namespace ropewalk
