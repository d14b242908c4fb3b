// How much the kernel of the line law has to do, counted outside of it: it follows all_elements() of
// sim/contact_line_kernel.cpp.
#pragma once

#include "sim/simulation.hpp"

namespace ropewalk {

// Floating-point operations (a fused multiply-add is two) of one radial evaluation, two nodes of two elements: 3
// for the separation, 5 for its square, 3 + 2 + 4 (degree - 1) for u and du/dy of the table's polynomial, 2 for
// force and energy, 6 for each of the two sums of forces. Look-ups, comparisons and selections are not counted.
constexpr int radial_operations(int degree) { return 3 + 5 + 3 + 2 + 4 * (degree - 1) + 2 + 12; }

// Numbers per element at one moment, or sums of them.
struct RadialCount {
  double runs = 0;         // within reach
  double nodes = 0;        // of the neighbours in them
  double evaluations = 0;  // radial ones, in all lanes of the vectors
  double useful = 0;       // those of nodes closer than the cutoff

  void add(const RadialCount& other, double share);
};

// Lanes of the kernel's vectors on this machine.
int radial_lanes(Interaction::Precision precision);

// Of the simulation's present state, from a few thousand of its elements.
RadialCount count_radial(const Simulation& simulation);

}  // namespace ropewalk
