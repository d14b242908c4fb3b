// The cost of dividing a scene among processes. A part has its own elements and copies of the other elements within
// their reach. Each part is computed alone, on one thread, and no message is sent.
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
// are across z; otherwise across the longest side of each piece.
std::vector<std::vector<PartCost>> cost_of_parts(const Topology& topology, const Interaction& interaction,
                                                 const State& state, int most, bool across_z);

// Time of one evaluation of the forces, s, for each own element and for each copy. Least squares over all parts
// minimise the relative deviations.
struct ElementCost {
  double own = 0, copy = 0;
};
ElementCost fit(const std::vector<std::vector<PartCost>>& cuts);

}  // namespace ropewalk
