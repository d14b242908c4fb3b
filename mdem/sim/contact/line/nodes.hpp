// The nodes of what a chunk acts on, in rows along the tubes, and what acts on them, back on their elements:
//
//   x_l = x + s_l n,     F = sum_l f_l,     M = sum_l s_l n x f_l
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "sim/contact/line/list.hpp"
#include "sim/contact/shared/buffer.hpp"
#include "sim/threads/scratch.hpp"

namespace ropewalk {

// Where nodes are: in units of the list as integers, or in nm.
template <class C>
struct LineNodes {
  std::vector<C> x, y, z;
  double per_unit = 1;

  void make_room(int nodes) {
    for (auto* v : {&x, &y, &z}) set_size(*v, static_cast<std::size_t>(nodes + NodeRow::pad));
  }
};

// Forces on the nodes that a chunk acts on, eV/nm: those of its parts one after another.
template <class T>
struct NodeForces {
  using Value = T;
  std::vector<T> x, y, z;
  std::vector<char> used;  // of the parts; the forces on the others are not even cleared

  void make_room(int nodes) {
    for (auto* v : {&x, &y, &z}) set_size(*v, static_cast<std::size_t>(nodes + NodeRow::pad));
  }
  void start(std::size_t parts) { used.assign(parts, 0); }
  void use(const LineChunk& chunk, Rows kind, int index) {
    char& done = used[static_cast<std::size_t>(index)];
    if (done) return;
    done = 1;
    clear(chunk.parts[static_cast<std::size_t>(index)], kind);
  }

 private:
  void clear(const TouchedPart& p, Rows kind) {
    const TouchedPart::Row& row = p.row[static_cast<int>(kind)];
    for (auto* v : {&x, &y, &z})
      std::fill_n(v->begin() + row.first(p.begin), (p.end - p.begin) * row.per_element, T{0});
  }
};

// Of the elements of one type in rows of one kind.
struct NodePlaces {
  static constexpr int room = 8;  // zeros behind them, for vectors that are not full
  std::vector<double> s;          // nm from the centre
  double step = 0;                // nm from one node to the next
};

// What the rows of a chunk are made of.
struct RowsOf {
  const LineChunk& chunk;
  const std::vector<int>& tube_type;
  const std::vector<NodePlaces> (&places)[row_kinds];  // of each tube type
  const Vec3Array& position;
  const Vec3Array& axis;
  double moved = 0;  // nm: by no more have distances become smaller since the list was built
};

// But for parts that nothing can act on. With the widest vectors that the machine has.
void place_nodes(const RowsOf& of, LineNodes<std::int32_t>* rows);
void place_nodes(const RowsOf& of, LineNodes<double>* rows);
// Adds what acts on the nodes to the buffer of the chunk.
void add_node_forces(const RowsOf& of, const NodeForces<float>* forces, ContactBuffer<float>& out);
void add_node_forces(const RowsOf& of, const NodeForces<double>* forces, ContactBuffer<double>& out);

// The places of `count` nodes on elements of a length (nm).
NodePlaces node_places(int count, double length);

}  // namespace ropewalk
