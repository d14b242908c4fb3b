// The topology of a part of a scene, for one of several processes: its own elements, and copies of others.
#pragma once

#include <vector>

#include "sim/state/interaction.hpp"
#include "sim/state/state.hpp"

namespace ropewalk {

// `number`: those of the scene that the process has, in rising order; `own`: which of them it owns.
Topology part_of_scene(const Topology& scene, std::vector<int> number, std::vector<char> own);
// The motion of these elements.
State part_of_state(const State& scene, const std::vector<int>& number);

// The number in the scene of a process's element, and back; -1: the process has no such element.
inline int number_in_scene(const Topology& here, int place) {
  return here.part ? here.part->number[static_cast<std::size_t>(place)] : place;
}
int place_of(const Topology& here, int number);
inline bool owns_number(const Topology& here, int number) {
  const int place = place_of(here, number);
  return place >= 0 && here.owns(place);
}
// The places of those `elements` (of the scene) that this process owns.
std::vector<int> own_places(const Topology& topology, const std::vector<int>& elements);

// A process needs copies of all elements within this distance (nm) of its own ones. The distance covers the
// contacts, with the skin of the neighbour list, the other end of a bond, and what force terms look at.
double copy_reach(const Topology& topology, const Interaction& interaction, double skin);

}  // namespace ropewalk
