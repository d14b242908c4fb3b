// Compact parts of a scene, for chunks of work that have little in common with each other.
#pragma once

#include <vector>

#include "sim/state.hpp"

namespace ropewalk {

// Consecutive elements begin .. end of a tube.
struct Segment {
  int tube = 0, begin = 0, end = 0;
};

// All tubes in parts of nearly the same length, for passes over all elements: one of a few hundred, or several
// where a tube is longer, so that there is work for some threads in a single tube.
class TubeParts {
 public:
  static constexpr int most = 512;  // elements

  TubeParts() = default;
  explicit TubeParts(const Topology& topology) { cut(topology); }
  void cut(const Topology& topology);  // anew, without new memory
  int count() const { return static_cast<int>(parts_.size()); }
  const Segment& operator[](int k) const { return parts_[static_cast<std::size_t>(k)]; }
  // The first one of a tube; those of the last tube end at begin(tubes).
  int begin(int tube) const { return begin_[static_cast<std::size_t>(tube)]; }

 private:
  std::vector<Segment> parts_;
  std::vector<int> begin_;
};

// Every element once, in `count` tiles of nearly equal cost (which is given for each element), some perhaps empty;
// the segments of each in the order of their elements. By recursive bisection: first into the tubes with low and
// with high numbers, which two threads have to themselves in every pass over the tubes; then by places, across
// where what is to be cut is longest (recursive coordinate bisection: Berger and Bokhari 1987,
// doi:10.1109/TC.1987.1676942). Tiles that follow each other lie near each other. They depend on the arguments
// alone. Places that are not finite are taken for zero.
std::vector<std::vector<Segment>> cut_into_tiles(const Topology& topology, const Vec3Array& position,
                                                 const std::vector<double>& cost, int count);

}  // namespace ropewalk
