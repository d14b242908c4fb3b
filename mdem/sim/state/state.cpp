#include "sim/state/state.hpp"

#include <algorithm>

namespace ropewalk {

int Topology::tube_of(int element) const {
  const auto after = std::upper_bound(tube_begin.begin(), tube_begin.end(), element);
  return static_cast<int>(after - tube_begin.begin()) - 1;
}

double Topology::largest_radius() const {
  double largest = 0;
  for (const TubeType& t : types) largest = std::max(largest, t.radius);
  return largest;
}

double Topology::longest_element() const {
  double longest = 0;
  for (const TubeType& t : types) longest = std::max(longest, t.element_length);
  return longest;
}

int Topology::fewest_within(double arc) const {
  int fewest = types.front().elements_within(arc);
  for (const TubeType& t : types) fewest = std::min(fewest, t.elements_within(arc));
  return fewest;
}

}  // namespace ropewalk
