#include "sim/state/part_of_scene.hpp"

#include <algorithm>
#include <utility>

#include "model/contract.hpp"

namespace ropewalk {

Topology part_of_scene(const Topology& scene, std::vector<int> number, std::vector<char> own) {
  ROPEWALK_EXPECTS(!scene.part && number.size() == own.size() && std::is_sorted(number.begin(), number.end()));
  Topology out;
  out.types = scene.types;
  PartOfScene& part = out.part.emplace();
  for (std::size_t i = 0, next; i < number.size(); i = next) {
    const int tube = scene.tube_of(number[i]), end = scene.tube_begin[static_cast<std::size_t>(tube) + 1];
    for (next = i + 1; next < number.size() && number[next] == number[next - 1] + 1 && number[next] < end;) ++next;
    out.add_tube(static_cast<int>(next - i), scene.tube_type[static_cast<std::size_t>(tube)]);
    const int last = scene.groups.ends_meet ? scene.strand_of(tube).second : tube;
    part.row_end.push_back(scene.tube_begin[static_cast<std::size_t>(last) + 1]);
  }
  part.number = std::move(number);
  part.own = std::move(own);
  ROPEWALK_ENSURES(out.elements() == static_cast<int>(part.number.size()));
  return out;
}

State part_of_state(const State& scene, const std::vector<int>& number) {
  State part(number.size());
  for (std::size_t k = 0; k < number.size(); ++k) {
    const auto i = static_cast<std::size_t>(number[k]);
    part.position.set(k, scene.position[i]);
    part.orientation.set(k, scene.orientation[i]);
    part.velocity.set(k, scene.velocity[i]);
    part.angular_velocity.set(k, scene.angular_velocity[i]);
  }
  return part;
}

int place_of(const Topology& here, int number) {
  if (!here.part) return number;
  const std::vector<int>& numbers = here.part->number;
  const auto at = std::lower_bound(numbers.begin(), numbers.end(), number);
  return at != numbers.end() && *at == number ? static_cast<int>(at - numbers.begin()) : -1;
}

std::vector<int> own_places(const Topology& topology, const std::vector<int>& elements) {
  if (!topology.part) return elements;
  std::vector<int> own;
  for (const int e : elements)
    if (const int place = place_of(topology, e); place >= 0 && topology.owns(place)) own.push_back(place);
  return own;
}

double copy_reach(const Topology& topology, const Interaction& in, double skin) {
  constexpr double longest_bond = 1.5;  // element lengths, far above any strain for which the model holds
  return std::max({in.cutoff(), in.term_copies, longest_bond * topology.longest_element()}) + skin;
}

}  // namespace ropewalk
