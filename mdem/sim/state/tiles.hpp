// Compact parts of a scene, so that chunks of work write to few common elements.
#pragma once

#include <vector>

#include "sim/state/state.hpp"

namespace ropewalk {

// Number of elements from which threads do all the work of a tile at once, while the tile is in their caches.
// Smaller scenes stay in the caches anyway, and pass by pass the threads share the work more evenly.
inline constexpr std::size_t large_scene = 20000;

// Consecutive elements begin .. end of a tube.
struct Segment {
  int tube = 0, begin = 0, end = 0;
};

// All tubes cut into parts of nearly equal length, for passes over all elements. A long tube has several parts, so
// that several threads can work on it. Consecutive short parts form blocks, which are one unit of such a pass.
// If other processes own some elements, a part has own ones or copies only.
class TubeParts {
 public:
  static constexpr int most = 512;                   // elements of a part
  static constexpr int max_block = cached_elements;  // a longer part is a block of its own

  TubeParts() = default;
  explicit TubeParts(const Topology& topology) { cut(topology); }
  void cut(const Topology& topology);  // again, in the same memory
  int count() const { return static_cast<int>(parts_.size()); }
  const Segment& operator[](int k) const { return parts_[static_cast<std::size_t>(k)]; }
  // First part of a tube; begin(tubes) is the number of parts.
  int begin(int tube) const { return begin_[static_cast<std::size_t>(tube)]; }
  int blocks() const { return static_cast<int>(block_begin_.size()) - 1; }
  // First part of a block; block_begin(blocks) is the number of parts.
  int block_begin(int block) const { return block_begin_[static_cast<std::size_t>(block)]; }
  int part_of(int element, int tube) const;
  int block_of(int part) const { return block_of_[static_cast<std::size_t>(part)]; }

 private:
  std::vector<Segment> parts_;
  std::vector<int> begin_, block_begin_{0}, block_of_;
};

// Into the tubes with low and with high numbers, which two threads have to themselves in every pass over the tubes;
// or across the longest side of each piece, so that tiles have least in common.
enum class CutBy { index, position };

// Cuts all own elements into `count` tiles of nearly equal cost; `cost` has one entry per element. The segments of
// a tile are in the order of their elements; a tile may be empty. The method is recursive coordinate bisection
// (Berger and Bokhari 1987, doi:10.1109/TC.1987.1676942), except for the first cut. Consecutive tiles lie near each
// other. The tiles depend on the arguments only. Positions that are not finite count as zero.
std::vector<std::vector<Segment>> cut_into_tiles(const Topology& topology, const Vec3Array& position,
                                                 const std::vector<double>& cost, int count, CutBy first);

}  // namespace ropewalk
