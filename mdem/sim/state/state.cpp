#include "sim/state/state.hpp"

#include <algorithm>

#include "model/contract.hpp"

namespace ropewalk {

int Topology::tube_of(int element) const {
  ROPEWALK_EXPECTS(element >= 0 && element < elements());
  const auto after = std::upper_bound(tube_begin.begin(), tube_begin.end(), element);
  return static_cast<int>(after - tube_begin.begin()) - 1;
}

int Topology::change_of_owner(int begin, int end) const {
  ROPEWALK_EXPECTS(begin < end);
  int i = begin;
  while (i < end && owns(i) == owns(begin)) ++i;
  return i;
}

int Topology::last_within(int elements, int element, int tube) const {
  ROPEWALK_EXPECTS(elements >= 0 && tube_of(element) == tube);
  const auto t = static_cast<std::size_t>(tube);
  if (!part) return std::min(element + elements, tube_begin[t + 1] - 1);
  // Other pieces of the tube may follow.
  const auto number = [&](int i) { return part->number[static_cast<std::size_t>(i)]; };
  const int limit = std::min(number(element) + elements, part->tube_end[t] - 1);
  int last = element;
  while (last + 1 < this->elements() && number(last + 1) <= limit) ++last;
  return last;
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
  ROPEWALK_EXPECTS(!types.empty());
  int fewest = types.front().elements_within(arc);
  for (const TubeType& t : types) fewest = std::min(fewest, t.elements_within(arc));
  return fewest;
}

}  // namespace ropewalk
