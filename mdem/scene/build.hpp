// From a scene to its elements at time zero, and the geometry of a hexagonal rope.
#pragma once

#include <utility>

#include "scene/scene.hpp"
#include "sim/state/state.hpp"

namespace ropewalk {

inline constexpr int max_elements = 10000000;  // in a scene: about 25 GB

struct BuiltScene {
  Topology topology;
  State state;
  double spacing = 0;  // nm: distance of neighbouring parallel tubes, typed or parallel_spacing()
};

// Also sets the reach of the scene's contact viscosity, which goes with the spacing.
BuiltScene build(Scene& scene);

// The largest hexagonal number (1, 7, 19, ...) that is not above `tubes`, and the smallest that is not below.
std::pair<int, int> nearest_hexagonal(int tubes);

// Places on the hexagonal lattice: the centre, then shell by shell, each counter-clockwise from the x axis.
std::vector<std::pair<double, double>> hexagonal_lattice(int tubes, double spacing);

// The distances of two parallel and of two crossed tubes (nm) at which their energy is lowest; without a law, that
// of their walls in graphite. Of several tube types, the largest.
double parallel_spacing(const Scene& scene);
double crossed_spacing(const Scene& scene);

// Elements of a tube: its length in whole elements.
int whole_elements(double length, double element_length);

}  // namespace ropewalk
