// Delaunay triangulation of points in the plane, by Qhull (Barber, Dobkin, Huhdanpaa, ACM Trans. Math. Softw.
// 22, 469 (1996), DOI 10.1145/235815.235821).
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

namespace ropewalk {

using Triangle = std::array<int, 3>;  // indices of points, counter-clockwise

// Empty for fewer than four points, for points on one line and for coordinates that are not finite: nothing
// there is worth a triangle, and a run must not end because a rope has come to lie in a plane. Triangles
// without area (three neighbours on a straight hull) are left out.
std::vector<Triangle> delaunay(const std::vector<Eigen::Vector2d>& points);

// How many points each point shares an edge with.
std::vector<int> edge_counts(const std::vector<Triangle>& triangles, int points);

}  // namespace ropewalk
