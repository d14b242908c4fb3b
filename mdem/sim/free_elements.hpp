// Which elements move by the forces on them alone, and which wait for what loads and constraints do to them.
#pragma once

#include <cstddef>
#include <vector>

#include "sim/tiles.hpp"

namespace ropewalk {

// Consecutive elements of tubes of one type.
struct ElementRange {
  std::ptrdiff_t begin = 0, end = 0;
  int type = 0;  // an index of Topology::types
};

class FreeElements {
 public:
  // Driven elements in rising order.
  FreeElements(const Topology& topology, const std::vector<int>& driven);

  // As many as TubeParts has.
  int blocks() const { return static_cast<int>(first_.size()) - 1; }
  // Those of a block that are not driven.
  const ElementRange* begin(int block) const { return free_.data() + first_[static_cast<std::size_t>(block)]; }
  const ElementRange* end(int block) const { return free_.data() + first_[static_cast<std::size_t>(block) + 1]; }
  const std::vector<ElementRange>& driven() const { return driven_; }
  const ElementRange* driven_begin(int block) const {
    return driven_.data() + first_driven_[static_cast<std::size_t>(block)];
  }
  const ElementRange* driven_end(int block) const {
    return driven_.data() + first_driven_[static_cast<std::size_t>(block) + 1];
  }

 private:
  std::vector<ElementRange> free_, driven_;
  std::vector<std::size_t> first_, first_driven_;  // of each block
};

}  // namespace ropewalk
