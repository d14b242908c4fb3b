#include "observe/voids.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

#include "observe/centre_line.hpp"

namespace ropewalk {
namespace {

constexpr double wide_ratio = 1.35;                         // ratio of circumradii
const double passage_ratio = 0.5 * (1.0 + std::sqrt(3.0));  // length in spacings
const double packed_circumradius = 1.0 / std::sqrt(3.0);    // radius in spacings
const double packed_area = 0.25 * std::sqrt(3.0);           // area in spacings squared

struct Measure {
  double circumradius = 0, area = 0;
};

Measure measure(const Triangle& t, const std::vector<Vector3>& points, const std::vector<Vector3>& tangents) {
  const Vector3 axis = (tangents[t[0]] + tangents[t[1]] + tangents[t[2]]).normalized();
  const Vector3 u = normal_part(points[t[1]] - points[t[0]], axis);
  const Vector3 v = normal_part(points[t[2]] - points[t[0]], axis);
  const double area = 0.5 * u.cross(v).norm();
  const double edges = u.norm() * v.norm() * (u - v).norm();
  return {area > 0.0 ? edges / (4.0 * area) : std::numeric_limits<double>::infinity(), area};
}

double separation(int i, int j, const std::vector<Vector3>& points, const std::vector<Vector3>& tangents) {
  return normal_part(points[j] - points[i], (tangents[i] + tangents[j]).normalized()).norm();
}

// Disjoint sets (union-find).
struct Groups {
  std::vector<int> parent;

  explicit Groups(std::size_t n) : parent(n) { std::iota(parent.begin(), parent.end(), 0); }
  int root(int i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  }
  void join(int i, int j) { parent[root(i)] = root(j); }
};

// The triangles on each edge: two inside, one on the hull (the other is -1).
using Edges = std::map<std::pair<int, int>, std::pair<int, int>>;

Edges edges_of(const std::vector<Triangle>& triangles) {
  Edges edges;
  for (int t = 0; t < static_cast<int>(triangles.size()); ++t)
    for (int k = 0; k < 3; ++k) {
      const auto edge = std::minmax({triangles[t][k], triangles[t][(k + 1) % 3]});
      const auto [at, fresh] = edges.try_emplace(edge, t, -1);
      if (!fresh) at->second.second = t;
    }
  return edges;
}

}  // namespace

Voids find_voids(const std::vector<Triangle>& triangles, const std::vector<Vector3>& points,
                 const std::vector<Vector3>& tangents, double spacing) {
  Voids voids;
  if (spacing <= 0.0) return voids;
  const std::size_t n = triangles.size();
  std::vector<Measure> size(n);
  std::vector<char> wide(n), open(n, 0);
  for (std::size_t t = 0; t < n; ++t) {
    size[t] = measure(triangles[t], points, tangents);
    wide[t] = size[t].circumradius > wide_ratio * packed_circumradius * spacing;
  }
  Groups groups(n);
  const Edges edges = edges_of(triangles);
  const auto passage = [&](const std::pair<int, int>& edge) {
    return separation(edge.first, edge.second, points, tangents) > passage_ratio * spacing;
  };
  for (const auto& [edge, sides] : edges)
    if (sides.second >= 0 && wide[sides.first] && wide[sides.second] && passage(edge))
      groups.join(sides.first, sides.second);
  for (const auto& [edge, sides] : edges)
    if (sides.second < 0 && wide[sides.first] && passage(edge)) open[groups.root(sides.first)] = 1;
  // Sides of each group: tubes that are pressed together leave less between them than the untwisted rope would.
  std::vector<double> length(n, 0), sides(n, 0), area(n, 0), triangles_in(n, 0);
  for (const auto& [edge, both] : edges)
    for (const int t : {both.first, both.second}) {
      const int other = t == both.first ? both.second : both.first;
      if (t < 0 || !wide[t] || (other >= 0 && groups.root(t) == groups.root(other))) continue;
      length[groups.root(t)] += separation(edge.first, edge.second, points, tangents);
      ++sides[groups.root(t)];
    }
  for (std::size_t t = 0; t < n; ++t) {
    const int group = groups.root(static_cast<int>(t));
    if (!wide[t] || open[group]) continue;
    area[group] += size[t].area;
    ++triangles_in[group];
  }
  for (std::size_t group = 0; group < n; ++group) {
    if (triangles_in[group] == 0) continue;
    const double side = sides[group] > 0 ? std::min(spacing, length[group] / sides[group]) : spacing;
    ++voids.count;
    voids.area += std::max(0.0, area[group] - triangles_in[group] * packed_area * side * side);
  }
  return voids;
}

}  // namespace ropewalk
