// The centre line of a rope: mean position of the elements of equal index.
#pragma once

#include <vector>

#include "sim/state/state.hpp"

namespace ropewalk {

struct CentreLine {
  std::vector<Vector3> points;    // nm
  std::vector<Vector3> tangents;  // unit: central differences, one-sided at the ends
};

// Elements per tube where all tubes have equally many, 0 otherwise.
int common_length(const Topology& topology);

// Whether all tubes run the same way, as those of a rope do: none from its first element to its last by more than 120
// degrees against their mean direction.
bool run_the_same_way(const Topology& topology, const State& state);

// Empty where the tubes have no common length.
CentreLine centre_line(const Topology& topology, const State& state);

// Direction of a tube at one of its elements from the positions of the adjacent ones; the element's own axis
// for a tube of one element.
Vector3 tube_tangent(const Topology& topology, const State& state, int tube, int index);

double arc_length(const std::vector<Vector3>& line);

// Largest distance from the chord, nm. (From the first point, where the line is closed.)
double chord_amplitude(const std::vector<Vector3>& line);

// The part of v across a unit axis.
inline Vector3 normal_part(const Vector3& v, const Vector3& axis) { return v - v.dot(axis) * axis; }

// Turns about the axis of the helix, positive for a right-handed one; see the .cpp for the estimator.
double chord_windings(const std::vector<Vector3>& line);

}  // namespace ropewalk
