// Elements of one tube that are so near each other along it that they are no neighbours.
#pragma once

#include <vector>

#include "sim/state/state.hpp"

namespace ropewalk {

// For each element the last one behind it within `arc` (nm) along the tube (Topology::last_within).
inline std::vector<int> last_excluded(const Topology& topology, double arc) {
  std::vector<int> last(static_cast<std::size_t>(topology.elements()));
  for (int t = 0; t < topology.tubes(); ++t) {
    const int excluded = topology.type_of(t).elements_within(arc);
    for (int i = topology.tube_begin[t]; i < topology.tube_begin[t + 1]; ++i)
      last[static_cast<std::size_t>(i)] = topology.last_within(excluded, i, t);
  }
  return last;
}

}  // namespace ropewalk
