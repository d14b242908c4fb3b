// What the line law's kernel runs over: rows of nodes along the tubes, and for every element the runs of
// consecutive nodes of other tubes within its reach. No index per pair, no gather.
#pragma once

#include <cstddef>
#include <vector>

#include "sim/interaction.hpp"
#include "sim/neighbours.hpp"

namespace ropewalk {

// Nodes of all tubes one after another, each tube followed by `pad` nodes that are read with its last ones.
struct NodeLayout {
  static constexpr int pad = 16;

  std::vector<int> per_element;  // of each tube type
  std::vector<int> begin;        // first node of each tube; begin[tubes] is the number of nodes with padding

  int first(const Topology& topology, int tube, int element) const {
    return begin[static_cast<std::size_t>(tube)] +
           (element - topology.tube_begin[tube]) * per_element[static_cast<std::size_t>(topology.tube_type[tube])];
  }
  int total() const { return begin.empty() ? 0 : begin.back(); }
};

// Neighbours of one element on one other tube, or on another part of its own.
struct LineRun {
  int element_begin = 0, element_end = 0;
  int row = 0;                           // first node of element_begin
  int node_begin = 0, node_end = 0;      // within reach
  int damped_begin = 0, damped_end = 0;  // elements within reach of the contact viscosity
  float beyond = 0;                      // nm: by so much the nearest node was out of reach at the build
  short type = 0;                        // tube type
  bool begins = false, ends = false;     // the element is the first, the last of its tube, and the only one here
};

class LineList {
 public:
  // From the pairs of the list and the places that it was built at. Throws std::invalid_argument where a tube
  // type has other numbers of nodes towards different partners.
  void build(const Topology& topology, const Interaction& interaction, const NeighbourList& list);

  const NodeLayout& layout() const { return layout_; }
  const LineRun* begin(int i) const { return run_.data() + begin_[static_cast<std::size_t>(i)]; }
  const LineRun* end(int i) const { return run_.data() + begin_[static_cast<std::size_t>(i) + 1]; }
  // A power of two (nm) that resolves every coordinate in 29 bits.
  double unit() const { return unit_; }
  std::size_t bytes() const { return run_.capacity() * sizeof(LineRun) + begin_.capacity() * sizeof(std::size_t); }
  std::size_t runs() const { return run_.size(); }

 private:
  // Of the elements of one tube, added to `runs`; begin_[i + 1] takes their number.
  void find_runs(const Topology& topology, const Interaction& interaction, const NeighbourList& list, int tube,
                 std::vector<LineRun>& runs);

  NodeLayout layout_;
  std::vector<std::size_t> begin_;
  std::vector<LineRun> run_;
  double unit_ = 0;
};

}  // namespace ropewalk
