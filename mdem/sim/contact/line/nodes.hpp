// The nodes of the elements that a chunk acts on, in rows along the tubes, and the forces on nodes brought back to
// their elements:
//
//   x_l = x + s_l n,     F = sum_l f_l,     M = sum_l s_l n x f_l
#pragma once

#include <cstdint>
#include <vector>

#include "sim/contact/line/list.hpp"
#include "sim/contact/shared/buffer.hpp"
#include "sim/threads/scratch.hpp"

namespace ropewalk {

// Entries behind the last node that vectors may read and write.
inline constexpr int node_padding = 16;

// Positions of the nodes of a chunk: integers in units of the list, or nm.
template <class C>
struct NodePositions {
  std::vector<C> x, y, z;

  void reserve(int nodes) {
    for (auto* v : {&x, &y, &z}) set_size(*v, static_cast<std::size_t>(nodes + node_padding));
  }
};

// Forces on the nodes of a chunk, eV/nm.
template <class T>
struct NodeForces {
  std::vector<T> x, y, z;

  void clear(int nodes) {
    for (auto* v : {&x, &y, &z}) set_zero(*v, static_cast<std::size_t>(nodes + node_padding));
  }
};

// The places of the nodes of one tube type on its elements.
struct NodeOffsets {
  static constexpr int padding = 8;  // zeros behind them, for vectors that are not full
  std::vector<double> s;             // nm from the centre
  double spacing = 0;                // nm
};
NodeOffsets node_offsets(int count, double length);

// The elements of a chunk.
struct NodeInput {
  const LineChunk& chunk;
  const std::vector<int>& tube_type;
  const std::vector<NodeOffsets>& offsets;  // offsets of each tube type
  const Vec3Array& position;
  const Vec3Array& axis;
};

// Uses the widest vectors that the machine has. `unit`: nm, of the integers.
void position_nodes(const NodeInput& of, double unit, NodePositions<std::int32_t>& out);
void position_nodes(const NodeInput& of, double unit, NodePositions<double>& out);
// Adds what acts on the nodes to the buffer of the chunk.
void add_node_forces(const NodeInput& of, const NodeForces<float>& forces, ContactBuffer<float>& out);
void add_node_forces(const NodeInput& of, const NodeForces<double>& forces, ContactBuffer<double>& out);

}  // namespace ropewalk
