// What it costs to cut a scene into the parts of many processes: each part is its own elements and copies of those
// within reach of them, and is computed alone, on one thread. No message is sent.
#pragma once

#include <vector>

#include "sim/state/interaction.hpp"
#include "sim/state/state.hpp"

namespace ropewalk {

struct PartCost {
  int own = 0, copies = 0;  // elements
  double pairs = 0;         // in the neighbour list
  double seconds = 0;       // of one evaluation of all forces, the shortest
};

// The costs of 1, 2, 4 ... up to `most` parts of equal numbers of elements, measured by turns. `across_z`: all cuts
// are across z; otherwise across the longest side of what is cut.
std::vector<std::vector<PartCost>> cost_of_parts(const Topology& topology, const Interaction& interaction,
                                                 const State& state, int most, bool across_z);

// Seconds for each own element and for each copy, fitted to all parts of these cuts by least squares of the
// relative deviations.
struct ElementCost {
  double own = 0, copy = 0;
};
ElementCost fit(const std::vector<std::vector<PartCost>>& cuts);

}  // namespace ropewalk
