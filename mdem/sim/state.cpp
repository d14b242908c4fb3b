#include "sim/state.hpp"

#include <algorithm>

namespace ropewalk {

int Topology::tube_of(int element) const {
  const auto after = std::upper_bound(tube_begin.begin(), tube_begin.end(), element);
  return static_cast<int>(after - tube_begin.begin()) - 1;
}

}  // namespace ropewalk
