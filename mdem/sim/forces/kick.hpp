// The kick of an integrator: velocities by forces, with the terms that act in it (ForceTerm::acts_in_kick).
#pragma once

#include <numeric>
#include <vector>

#include "sim/forces/forces.hpp"
#include "sim/threads/for_each.hpp"

namespace ropewalk {

// v += F dt/m,  w += M dt/I  of the elements of a segment. `terms`: those that act in the kick, or null. Returns
// the energy (eV) that they take out: the work of their forces at the mean of the velocities before and after.
double kick(const Topology& topology, const ForceTerms* terms, const ForceRows& total, double dt, const Segment& of,
            State& state);

// The same of `count` segments that do not overlap, segment(k), by all threads; summed in their order.
template <class SegmentOf>
double kick_all(const Topology& topology, const ForceTerms& terms, const ForceRows& total, double dt, int count,
                const SegmentOf& segment, State& state) {
  const ForceTerms* const acting = terms.act_in_kick() ? &terms : nullptr;
  std::vector<double> removed(static_cast<std::size_t>(acting ? count : 0));
  for_each(count, state.size() > parallel_from, [&](int k) {
    const double energy = kick(topology, acting, total, dt, segment(k), state);
    if (acting) removed[static_cast<std::size_t>(k)] = energy;
  });
  return std::accumulate(removed.begin(), removed.end(), 0.0);
}

}  // namespace ropewalk
