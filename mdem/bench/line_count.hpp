// How much the kernel of the line law has to do, counted outside of it, for `bench` and the micro-benchmarks.
#pragma once

#include "sim/contact/line/list.hpp"

namespace ropewalk {

// Numbers per element at one moment, or sums of them.
struct RadialCount {
  double runs = 0;         // within reach
  double skipped = 0;      // out of it for now
  double pairs = 0;        // of elements summed one by one: ends of tubes, and angles between sparse and dense
  double nodes = 0;        // of the neighbours in the runs that are rows
  double vectors = 0;      // evaluated
  double evaluations = 0;  // radial ones, in all lanes of the vectors
  double useful = 0;       // those of nodes closer than the cutoff

  void add(const RadialCount& other, double share);
};

// Lanes of the kernel's vectors with the instructions in use.
int radial_lanes(Interaction::Precision precision);

// Floating-point operations (a fused multiply-add is two) of one radial evaluation, two nodes of two elements: 3
// for the separation, 5 for its square, those of the polynomial (radial_table.hpp), 1 for the force, 6 for each of
// the two sums of forces. Look-ups, comparisons and selections are not counted, nor energies, which are only summed
// where they are reported.
int radial_operations(Interaction::Precision precision);

// Of the present state, from up to `most` of its elements.
RadialCount count_radial(const Topology& topology, const Interaction& interaction, const State& state,
                         const NeighbourList& neighbours, const LineList& list, int most);

}  // namespace ropewalk
