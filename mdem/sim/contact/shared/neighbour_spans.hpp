// Neighbour spans for the kernel of the published law. They are cut to the kernel's capacity and leave out pairs
// beyond the cutoff of this law, since the Verlet list may reach farther. They are built after every build of the
// list.
#pragma once

#include <cstddef>
#include <vector>

#include "sim/neighbours/neighbours.hpp"

namespace ropewalk {

class ElementSpans {
 public:
  static constexpr int longest = 64;  // elements; longer spans are cut
  // Takes the pairs of the list that can come closer than `reach` (nm) before the next build of the list.
  void build(const NeighbourList& list, double reach);

  Span<ElementSpan> spans(int i) const { return entries_of(i, begin_, spans_); }
  std::size_t count() const { return spans_.size(); }
  std::size_t bytes() const {
    return spans_.capacity() * sizeof(ElementSpan) + begin_.capacity() * sizeof(std::size_t);
  }

 private:
  std::vector<std::size_t> begin_;
  std::vector<ElementSpan> spans_;
};

}  // namespace ropewalk
