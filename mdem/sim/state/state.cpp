#include "sim/state/state.hpp"

#include <algorithm>

#include "model/contract.hpp"

namespace ropewalk {

int Topology::tube_of(int element) const {
  ROPEWALK_EXPECTS(element >= 0 && element < elements());
  const auto after = std::upper_bound(tube_begin.begin(), tube_begin.end(), element);
  return static_cast<int>(after - tube_begin.begin()) - 1;
}

bool Topology::begins_strand(int tube) const {
  return groups.strand_begin.empty() ||
         std::binary_search(groups.strand_begin.begin(), groups.strand_begin.end(), tube);
}

bool Topology::ends_strand(int tube) const {
  return groups.strand_begin.empty() ||
         std::binary_search(groups.strand_begin.begin(), groups.strand_begin.end(), tube + 1);
}

namespace {

// An element in its strand of a slice.
struct InSlice {
  int place = 0, own = 0, images = 0;

  InSlice(const Topology& topology, int element) {
    const int strand = topology.elements() / topology.strands();
    place = element % strand;
    own = strand - 2 * topology.groups.images;
    images = topology.groups.images;
  }
  bool is_own() const { return place >= images && place < images + own; }
};

}  // namespace

int Topology::original_of(int element) const {
  ROPEWALK_EXPECTS(element >= 0 && element < elements());
  if (groups.images == 0) return element;
  const InSlice at(*this, element);
  if (at.is_own()) return element;
  return at.place < groups.images ? element + at.own : element - at.own;
}

int Topology::image_above(int element) const {
  if (groups.images == 0) return -1;
  const InSlice at(*this, element);
  return at.is_own() && at.place < 2 * groups.images ? element + at.own : -1;
}

int Topology::image_below(int element) const {
  if (groups.images == 0) return -1;
  const InSlice at(*this, element);
  return at.is_own() && at.place >= at.own ? element - at.own : -1;
}

int Topology::own_elements(int tube) const {
  if (groups.images == 0) return length_of(tube);
  const int strand = elements() / strands(), first = tube_begin[tube] / strand * strand;
  return std::max(0, std::min(tube_begin[tube + 1], first + strand - groups.images) -
                         std::max(tube_begin[tube], first + groups.images));
}

std::pair<int, int> Topology::strands_of_rope(int rope) const {
  ROPEWALK_EXPECTS(rope >= 0 && rope < ropes());
  if (groups.rope_begin.empty()) return {0, strands()};
  return {groups.rope_begin[static_cast<std::size_t>(rope)], groups.rope_begin[static_cast<std::size_t>(rope) + 1]};
}

std::pair<int, int> Topology::strand_of(int tube) const {
  int first = tube, last = tube;
  while (!begins_strand(first)) --first;
  while (!ends_strand(last)) ++last;
  return {first, last};
}

Topology cut_behind(const Topology& topology, const std::vector<char>& flags) {
  ROPEWALK_EXPECTS(static_cast<int>(flags.size()) == topology.elements() && !topology.part);
  Topology cut;
  cut.types = topology.types;
  cut.groups = topology.groups;
  cut.groups.strand_begin = {0};
  cut.groups.ends_meet = false;
  for (int t = 0; t < topology.tubes(); ++t) {
    int begin = topology.tube_begin[t];
    for (int i = begin; i < topology.tube_begin[t + 1]; ++i) {
      if (i + 1 < topology.tube_begin[t + 1] && !flags[static_cast<std::size_t>(i)]) continue;
      cut.add_tube(i + 1 - begin, topology.tube_type[t]);
      begin = i + 1;
    }
    if (topology.ends_strand(t)) cut.groups.strand_begin.push_back(cut.tubes());
  }
  return cut;
}

Topology strands_of(const Topology& topology) {
  if (topology.groups.strand_begin.empty()) return topology;
  Topology strands;
  strands.types = topology.types;
  strands.groups = topology.groups;
  strands.groups.strand_begin.clear();
  strands.groups.ends_meet = false;
  for (int s = 0; s < topology.strands(); ++s) {
    const auto first = static_cast<std::size_t>(topology.groups.strand_begin[static_cast<std::size_t>(s)]),
               behind = static_cast<std::size_t>(topology.groups.strand_begin[static_cast<std::size_t>(s) + 1]);
    strands.add_tube(topology.tube_begin[behind] - topology.tube_begin[first], topology.tube_type[first]);
  }
  return strands;
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
  if (!part) {
    std::size_t last_tube = t;
    const int last = element + elements;
    while (groups.ends_meet && tube_begin[last_tube + 1] <= last && !ends_strand(static_cast<int>(last_tube)))
      ++last_tube;
    return std::min(last, tube_begin[last_tube + 1] - 1);
  }
  ROPEWALK_EXPECTS(!groups.ends_meet);
  // Other pieces of the tube, or of the strand, may follow.
  const auto number = [&](int i) { return part->number[static_cast<std::size_t>(i)]; };
  const int limit = std::min(number(element) + elements, part->row_end[t] - 1);
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
