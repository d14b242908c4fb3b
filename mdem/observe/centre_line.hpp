// The centre line of a rope: mean position of the elements of equal index.
#pragma once

#include <limits>
#include <vector>

#include "sim/state/state.hpp"

namespace ropewalk {

struct CentreLine {
  std::vector<Vector3> points;    // nm
  std::vector<Vector3> tangents;  // unit: central differences, one-sided at the ends
};

// Elements per tube where all tubes have equally many, 0 otherwise.
int common_length(const Topology& topology);

// Whether all tubes run the same way, as those of a rope do: none from its first element to its last by more than
// 120 degrees against their mean direction.
bool run_the_same_way(const Topology& topology, const State& state);

// Empty where the tubes have no common length.
CentreLine centre_line(const Topology& topology, const State& state);
// That of each plied rope (TubeGroups::rope_begin), whose strands are the tubes of `topology`.
std::vector<CentreLine> rope_lines(const Topology& topology, const State& state);

// Direction of a tube at one of its elements from the positions of the adjacent ones; the element's own axis
// for a tube of one element.
Vector3 tube_tangent(const Topology& topology, const State& state, int tube, int index);

double arc_length(const std::vector<Vector3>& line);

// Largest distance from the chord, nm. (From the first point, where the line is closed.)
double chord_amplitude(const std::vector<Vector3>& line);

// The middle 80 %, by number.
std::vector<Vector3> middle_of(const std::vector<Vector3>& line);

// The Gauss integral of the line with itself, in turns, positive where it is right-handed:
//   1/(4 pi) int int (t_i x t_j) . (x_i - x_j)/|x_i - x_j|^3
// by the exact solid angle of each two pieces (K. Klenin, J. Langowski, Biopolymers 54, 307 (2000), method 1a), of
// at most 128 pieces. A helix has 1 - sin(angle of pitch) for each turn, a loop that a rope has thrown about 1.
double writhe_of(const std::vector<Vector3>& line);

// The part of its length that runs against its chord: of every loop some, of a helix none.
double turned_back(const std::vector<Vector3>& line);

// The part of v across a unit axis.
inline Vector3 normal_part(const Vector3& v, const Vector3& axis) { return v - v.dot(axis) * axis; }

// The helix that a line makes about its axis; see the .cpp for the estimator.
struct LineHelix {
  double windings = 0;  // turns about the axis, positive for a right-handed helix
  double radius = 0;    // nm: root mean square of the distances from the axis, where the line is not straight
  double pitch = std::numeric_limits<double>::quiet_NaN();  // nm along the axis for a turn; nan below half a turn
};
LineHelix helix_of(const std::vector<Vector3>& line);

}  // namespace ropewalk
