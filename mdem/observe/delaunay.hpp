// Delaunay triangulation of points in the plane, by Qhull (Barber, Dobkin, Huhdanpaa, ACM Trans. Math. Softw.
// 22, 469 (1996), DOI 10.1145/235815.235821).
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

namespace ropewalk {

using Triangle = std::array<int, 3>;  // indices of points, counter-clockwise

// The result is empty for fewer than four points, for points on one line and for coordinates that are not finite:
// none of these is an error, since a rope may come to lie in a plane during a run. Triangles without area (three
// neighbours on a straight hull) are left out.
std::vector<Triangle> delaunay(const std::vector<Eigen::Vector2d>& points);

// The number of points with which each point shares an edge.
std::vector<int> edge_counts(const std::vector<Triangle>& triangles, int points);

}  // namespace ropewalk
