// Contact viscosity (model/damping.hpp) of all pairs of elements within its reach, in blocks: up to eight
// consecutive elements of one tube meet those of another that are 0, 1, .. places further along. Loads and stores
// are of consecutive elements, and no lanes are added up.
#pragma once

#include <vector>

#include "sim/contact_kernel.hpp"

namespace ropewalk {

// Of a chunk: consecutive elements of one tube that it acts on; element j is entry j + shift of its buffer.
struct TouchedRange {
  int begin = 0, end = 0, shift = 0;
};

// Element i + l meets element j + l + c for l < lanes and c < offsets, where that is one of `partners`.
struct DampedBlock {
  static constexpr int most = 8;
  int i = 0, j = 0, at_i = 0;  // elements; i's entry in the buffer
  short lanes = 0, offsets = 0;
  TouchedRange partners;
};

// The blocks of one chunk. Every pair may come once only, and all pairs of two tubes may that lie between the first
// and the last range of an element with another: those out of reach have no weight.
class DampedBlocks {
 public:
  // Elements from .. to - 1 are within reach of i, which is one of `own`. Elements i in rising order.
  void add(int i, const TouchedRange& own, int from, int to, const TouchedRange& partners);
  std::vector<DampedBlock> take();

 private:
  struct Range {
    int from, to;  // j - i
    TouchedRange partners;
  };
  void finish_group();

  int first_ = 0, lanes_ = 0, at_ = 0;  // elements of the group, and the first one's entry
  std::vector<Range> ranges_;
  std::vector<DampedBlock> blocks_;
};

// With the widest vectors that the machine has. In the buffer up to DampedBlock::most entries before the first
// element and behind the last are read and written as they were.
void contact_damping(const ContactViscosity& viscosity, const State& state, const std::vector<DampedBlock>& blocks,
                     ContactBuffer& out);

}  // namespace ropewalk
