// What force terms take out of the motion.
#pragma once

#include <string>
#include <vector>

#include "sim/state/interaction.hpp"

namespace ropewalk {

// A force term of this name takes the heat out at this rate, the mean over all motions, 1/ps.
struct TermDamping {
  std::string name;
  double rate = 0;
};
// Measured on the state, with random velocities of this temperature (K): the part of the forces that turns round
// with them. So it needs no word of the term itself.
std::vector<TermDamping> damping_of_terms(const Topology& topology, const Interaction& interaction,
                                          const State& state, double temperature);

}  // namespace ropewalk
