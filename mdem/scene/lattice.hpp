// The hexagonal lattice of a rope, and lengths in whole elements.
#pragma once

#include <utility>
#include <vector>

namespace ropewalk {

// The largest hexagonal number (1, 7, 19, ...) that is not above `tubes`, and the smallest that is not below.
std::pair<int, int> nearest_hexagonal(int tubes);

// Places on the hexagonal lattice: the centre, then shell by shell, each counter-clockwise from the x axis.
std::vector<std::pair<double, double>> hexagonal_lattice(int tubes, double spacing);

// Elements of a tube: its length in whole elements.
int whole_elements(double length, double element_length);

}  // namespace ropewalk
