// Verlet list: every pair of elements closer than cutoff + skin, found on a cell grid, valid until a point of an
// element has moved half the skin. Half list (j > i), sorted by j, so that the order of summation depends on
// the positions at the last build alone, never on the number of threads or on the grid. Along a tube the neighbours
// of an element follow one another: they are kept as spans, without an index per pair.
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "model/contract.hpp"
#include "sim/neighbours/motion_since.hpp"
#include "sim/state/interaction.hpp"
#include "sim/state/state.hpp"
#include "sim/threads/span.hpp"

namespace ropewalk {

// Consecutive elements.
struct ElementSpan {
  int begin = 0, end = 0;
};

// A span may go on from one tube to the next: work(tube, begin, end) for the part of it in each.
template <class Work>
void for_tubes_of(const Topology& topology, const ElementSpan& span, const Work& work) {
  for (int from = span.begin, to; from < span.end; from = to) {
    const int tube = topology.tube_of(from);
    to = std::min(span.end, topology.tube_begin[static_cast<std::size_t>(tube) + 1]);
    work(tube, from, to);
  }
}

class NeighbourList {
 public:
  // A contiguous range of elements whose pairs are one unit of parallel work. The number of chunks is fixed,
  // and each sums into a buffer of its own that covers [written_begin, written_end).
  struct Chunk {
    int begin = 0, end = 0;
    int written_begin = 0, written_end = 0;
  };
  // Largest number of chunks. It depends on the number of elements, not of threads. Buffers of chunks overlap,
  // which costs time, so that few elements get few chunks.
  static int chunk_count(int elements, bool whole_ranges) {
    if (elements <= static_cast<int>(parallel_from)) return 1;  // a single thread does the work
    return std::min(64, std::max(4, elements / (whole_ranges ? 2048 : 256)));
  }

  double cutoff = 0;          // nm
  double skin = 0;            // nm
  double lever = 0;           // nm: turning moves the points of an element that are so far from its centre
  bool whole_ranges = false;  // buffers of the chunks cover [written_begin, written_end), used or not
  double excluded_arc = 0;    // nm: that of the interaction
  const AllProcesses* others = nullptr;  // that own elements of the scene, or none

  NeighbourList() = default;
  // A list with the reach of all interactions; not yet built.
  NeighbourList(const Interaction& in, double skin_nm)
      : cutoff(in.cutoff()),
        skin(skin_nm),
        lever(in.lever()),
        whole_ranges(in.whole_ranges()),
        excluded_arc(in.excluded_arc()) {}

  // Rebuilds the list if an element has moved too far; returns whether it did. A position that is not finite counts
  // as moved; the rebuilt list has no neighbours of that element.
  bool update(const Topology& topology, const State& state);
  // Whether the list must be rebuilt after this change since the last build, of all own elements. All processes
  // must call it, and likewise build().
  bool stale(const Change& change);
  // The change of the elements begin .. end - 1; infinite where a place is not finite.
  Change change(const State& state, std::ptrdiff_t begin, std::ptrdiff_t end) const;
  void build(const Topology& topology, const State& state);
  void build(const Topology& topology, Vec3Array position, Vec3Array axis);
  // The two parts of build(). Without the second there are no pairs, and another processor finds its own.
  void begin(const Topology& topology, const State& state);
  void begin(const Topology& topology, Vec3Array position, Vec3Array axis);
  void find_pairs(const Topology& topology);
  bool has_pairs() const { return !begin_.empty(); }

  // The neighbours j > i of element i, none of which is in two spans.
  Span<ElementSpan> spans(int i) const {
    ROPEWALK_EXPECTS(has_pairs());
    return entries_of(i, begin_, spans_);
  }
  template <class Work>
  void for_neighbours(int i, const Work& work) const {
    for (const ElementSpan& span : spans(i))
      for (int j = span.begin; j < span.end; ++j) work(j);
  }
  std::size_t pairs() const { return pairs_; }
  std::size_t pairs(int i) const {
    std::size_t sum = 0;
    for (const ElementSpan& span : spans(i)) sum += static_cast<std::size_t>(span.end - span.begin);
    return sum;
  }
  const std::vector<Chunk>& chunks() const { return chunks_; }
  // Positions and axes at the last build. A checkpoint stores them, so that a resumed run rebuilds the same list
  // and gives the same bits.
  const Vec3Array& reference() const { return since_.position(); }
  const Vec3Array& reference_axis() const { return since_.axis(); }
  long builds() const { return builds_; }
  // nm, a power of two: the unit of coordinates modulo 2^32 (sim/contact/shared/wrapped.hpp). 2^-24, or more where
  // elements so long that 2^32 units are not 32 times as far as elements act on each other.
  double coordinate_unit() const;
  // Differs for every build of every list.
  long stamp() const { return stamp_; }
  // Half of the largest possible change (nm) of the distance of two points within reach, from the last build to the
  // last call of update() or stale(). A common twist of the rope does not count.
  double displacement() const { return displacement_; }
  // The common twist since the build. A checkpoint stores it, so that a resumed run has the next build at the same
  // step.
  std::array<double, 2> twist() const { return since_.twist(); }
  void set_twist(const std::array<double, 2>& t) { since_.set_twist(t); }
  // What change() measures against, for another processor that does so.
  const TwistOfAll& common_twist() const { return since_.common_twist(); }
  // nm: largest distance of the centres of two elements that have points within reach of one another.
  double within() const { return cutoff + skin + 2 * lever; }
  std::size_t bytes() const {
    return spans_.capacity() * sizeof(ElementSpan) + begin_.capacity() * sizeof(std::size_t);
  }

 private:
  void cut_into_chunks(int elements);
  void cut_into_chunks(int elements, int count);

  std::vector<std::size_t> begin_;  // first span of each element, and the end of the last one's
  std::vector<ElementSpan> spans_;
  std::size_t pairs_ = 0;
  std::vector<Chunk> chunks_;
  MotionSince since_;
  long builds_ = 0, stamp_ = 0;
  double displacement_ = 0;
};

}  // namespace ropewalk
