// relax_spins() (sim/dynamics/loads.hpp) where several processes have parts of a tube, and when it is due.
#pragma once

#include <vector>

#include "sim/state/state.hpp"

namespace ropewalk {

// Whether spins are relaxed at the end of a step (ps) that ends at `time`. interval: Load::spin_relaxation_interval.
bool relaxes_spins_at(double time, double step, double interval);

// `known`: elements whose orientation is final, at first the own ones that are the middle of a tube. Each own element
// beside a known one follows it, and so on along the tube. Returns these elements. The process that has the next part
// goes on from a copy of the last one of them.
std::vector<int> middles_of_tubes(const Topology& scene, const Topology& here);
std::vector<int> follow_spins(const Topology& topology, std::vector<char>& known, State& state);
// Own elements no longer turn about their axes.
void take_spin_velocities_away(const Topology& topology, State& state);

}  // namespace ropewalk
