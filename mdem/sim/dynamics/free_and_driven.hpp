// Which elements move by the forces on them alone, and which wait for what loads and constraints do to them.
#pragma once

#include <cstddef>
#include <vector>

#include "sim/state/tiles.hpp"
#include "sim/threads/span.hpp"

namespace ropewalk {

// Consecutive elements of tubes of one type.
struct ElementRange {
  std::ptrdiff_t begin = 0, end = 0;
  int type = 0;  // an index of Topology::types
};

class FreeAndDriven {
 public:
  // Driven elements in rising order.
  FreeAndDriven(const Topology& topology, const std::vector<int>& driven);

  // As many as TubeParts has.
  int blocks() const { return static_cast<int>(first_free_.size()) - 1; }
  Span<ElementRange> free(int block) const { return entries_of(block, first_free_, free_); }
  Span<ElementRange> driven(int block) const { return entries_of(block, first_driven_, driven_); }
  // Of all blocks.
  Span<ElementRange> driven() const { return {driven_.data(), driven_.data() + driven_.size()}; }

 private:
  std::vector<ElementRange> free_, driven_;
  std::vector<std::size_t> first_free_, first_driven_;  // of each block
};

}  // namespace ropewalk
