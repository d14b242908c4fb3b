// Contact viscosity (model/damping.hpp) of all pairs of elements within its reach. Pairs are evaluated in blocks:
// up to 16 consecutive elements of one tube against as many of another tube, once for every offset along it. So all
// loads and stores are of consecutive elements, and no sum over lanes is needed. There are two precisions: double,
// straight from the state; and single, from copies of the elements of a chunk with integer positions, whose
// differences are exact.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "sim/contact/pair_work.hpp"
#include "sim/threads/scratch.hpp"

namespace ropewalk {

// The pairs (i + l, j + l + c) for l < lanes and c < offsets, if j + l + c is one of `partners`.
struct DampedBlock {
  static constexpr int max_lanes = 16;  // lanes of the widest vectors
  int i = 0, j = 0, at_i = 0;           // elements; i's entry in the buffer
  short lanes = 0, offsets = 0;
  BufferRange partners;
};

// Collects the blocks of one chunk. A pair may be added once only. Blocks may include further pairs of the same two
// tubes, which lie between ranges that were added; out of reach the viscosity is zero.
class DampedBlocks {
 public:
  // Elements from .. to - 1 are within reach of i, which is one of `own`. Elements i in rising order.
  void add(int i, const BufferRange& own, int from, int to, const BufferRange& partners);
  std::vector<DampedBlock> take();

 private:
  struct Offsets {
    int from, to;  // j - i
    BufferRange partners;
  };
  void finish_group();

  int first_ = 0, lanes_ = 0, at_ = 0;  // elements of the group, and the first one's entry
  std::vector<Offsets> ranges_;
  std::vector<DampedBlock> blocks_;
};

// Copies of the elements of a chunk, by their entries in its buffer: positions in integer units, velocities in
// nm/ps and rad/ps.
struct DampedElements {
  std::vector<std::uint32_t> x, y, z;
  std::vector<float> vx, vy, vz, wx, wy, wz;

  void resize(int elements) {
    const auto entries = static_cast<std::size_t>(elements + DampedBlock::max_lanes);
    for (auto* v : {&x, &y, &z}) set_size(*v, entries);
    for (auto* v : {&vx, &vy, &vz, &wx, &wy, &wz}) set_size(*v, entries);
  }
  std::size_t bytes() const { return 3 * x.capacity() * sizeof(x[0]) + 6 * vx.capacity() * sizeof(vx[0]); }
};

// Adds damping forces to the buffer, with the widest vectors of the machine. Up to DampedBlock::max_lanes entries
// on either side of a part are read and written back unchanged. Returns the power, eV/ps.
double contact_damping(const ContactViscosity& viscosity, const State& state,
                       const std::vector<DampedBlock>& blocks, ContactBuffer<double>& out);

// The blocks of a chunk, the ranges of their elements, and the unit of the integer positions (nm).
struct DampedChunk {
  const std::vector<DampedBlock>& blocks;
  const std::vector<BufferRange>& parts;
  double unit;
};
// The same in single precision.
double contact_damping(const ContactViscosity& viscosity, const State& state, const DampedChunk& of,
                       DampedElements& elements, ContactBuffer<float>& out);

}  // namespace ropewalk
