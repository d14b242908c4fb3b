// Compact parts of a scene, for chunks of work that have little in common with each other.
#pragma once

#include <vector>

#include "sim/state/state.hpp"

namespace ropewalk {

// Elements from which on threads go from tile to tile and do all that a tile needs at once, while it is in their
// caches. Fewer stay there anyway, and pass by pass the threads share the work more evenly.
inline constexpr std::size_t large_scene = 20000;

// Consecutive elements begin .. end of a tube.
struct Segment {
  int tube = 0, begin = 0, end = 0;
};

// All tubes in parts of nearly the same length, for passes over all elements: one of a few hundred, or several
// where a tube is longer, so that there is work for some threads in a single tube. Parts that follow each other are
// taken together in blocks, for what is done to many elements at once.
class TubeParts {
 public:
  static constexpr int most = 512;                       // elements of a part
  static constexpr int most_of_block = cached_elements;  // a longer part is a block of its own

  TubeParts() = default;
  explicit TubeParts(const Topology& topology) { cut(topology); }
  void cut(const Topology& topology);  // anew, without new memory
  int count() const { return static_cast<int>(parts_.size()); }
  const Segment& operator[](int k) const { return parts_[static_cast<std::size_t>(k)]; }
  // The first one of a tube; those of the last tube end at begin(tubes).
  int begin(int tube) const { return begin_[static_cast<std::size_t>(tube)]; }
  int blocks() const { return static_cast<int>(block_begin_.size()) - 1; }
  // The first one of a block; those of the last block end at block_begin(blocks).
  int block_begin(int block) const { return block_begin_[static_cast<std::size_t>(block)]; }
  int part_of(int element, int tube) const;
  int block_of(int part) const { return block_of_[static_cast<std::size_t>(part)]; }

 private:
  std::vector<Segment> parts_;
  std::vector<int> begin_, block_begin_{0}, block_of_;
};

// Into the tubes with low and with high numbers, which two threads have to themselves in every pass over the tubes;
// or across where what is to be cut is longest, so that tiles have least in common.
enum class CutBy { index, place };

// Every element once, in `count` tiles of nearly equal cost (which is given for each element), some perhaps empty;
// the segments of each in the order of their elements. By recursive bisection, the first as asked for and the
// others by places (recursive coordinate bisection: Berger and Bokhari 1987, doi:10.1109/TC.1987.1676942). Tiles
// that follow each other lie near each other. They depend on the arguments alone. Places that are not finite are
// taken for zero.
std::vector<std::vector<Segment>> cut_into_tiles(const Topology& topology, const Vec3Array& position,
                                                 const std::vector<double>& cost, int count, CutBy first);

}  // namespace ropewalk
