// Counts of the work of the line law's kernel, made outside of the kernel, for `bench` and the micro-benchmarks.
#pragma once

#include "sim/contact/line/list.hpp"

namespace ropewalk {

// Numbers per element at one time, or sums of them.
struct RadialCount {
  double spans = 0;        // within reach
  double skipped = 0;      // out of reach at present
  double nodes = 0;        // nodes of the neighbours within reach of the element
  double evaluations = 0;  // evaluations of u in all lanes of the vectors
  double useful = 0;       // those of nodes closer than the cutoff

  void add(const RadialCount& other, double share);
};

// The number of values that one vector of the line law's kernel holds on this machine.
int radial_lanes(Interaction::Precision precision);

// Floating-point operations (a fused multiply-add is two) of one evaluation, that is of two nodes of two elements:
// 3 for the squared distance, those of the polynomial (radial_table.hpp) and 3 for the two sums of forces. Not
// counted: look-ups, comparisons, selections, work done once for a node of a neighbour, and energies, which are
// only summed where they are reported.
int radial_operations(Interaction::Precision precision);

// Counts for the present state by the line law, from up to `most` of its elements.
RadialCount count_radial(const Topology& topology, const Interaction& interaction, const State& state,
                         const NeighbourList& neighbours, const LineList& list, int most);

}  // namespace ropewalk
