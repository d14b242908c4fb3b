// Neighbours, packing charge and voids of one cross-section.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "observe/centre_line.hpp"
#include "observe/delaunay.hpp"
#include "observe/observe.hpp"
#include "observe/voids.hpp"

namespace ropewalk {
namespace {

// Midway between the first and the second shell of the hexagonal packing, in spacings. The published radius, sqrt 3
// times 1.76 nm, would count second neighbours at the spacing of the published contact.
const double between_shells = 0.5 * (1.0 + std::sqrt(3.0));

double limit_of(double neighbour_radius, double spacing) {
  return neighbour_radius > 0.0 ? neighbour_radius : between_shells * spacing;
}

// Smallest distance between the elements section-1 .. section+1 of two tubes.
double tube_distance(const Topology& topology, const State& state, int a, int b, int section) {
  const int n = topology.length_of(a);
  const int from = std::max(section - 1, 0), to = std::min(section + 1, n - 1);
  double smallest = std::numeric_limits<double>::infinity();
  for (int i = from; i <= to; ++i)
    for (int j = from; j <= to; ++j) {
      const Vector3 d = state.position[topology.tube_begin[a] + i] - state.position[topology.tube_begin[b] + j];
      smallest = std::min(smallest, d.squaredNorm());
    }
  return std::sqrt(smallest);
}

// Distances of all pairs a < b of tubes, row by row; infinite between plied ropes.
std::vector<double> tube_distances(const Topology& topology, const State& state, int section) {
  std::vector<double> distances;
  for (int rope = 0; rope < topology.ropes(); ++rope) {
    const auto [from, behind] = topology.strands_of_rope(rope);
    for (int a = from; a < behind; ++a)
      for (int b = a + 1; b < topology.tubes(); ++b)
        distances.push_back(b < behind ? tube_distance(topology, state, a, b, section)
                                       : std::numeric_limits<double>::infinity());
  }
  return distances;
}

std::vector<int> neighbours_within(int tubes, const std::vector<double>& distances, double limit) {
  std::vector<int> count(tubes, 0);
  std::size_t pair = 0;
  for (int a = 0; a < tubes; ++a)
    for (int b = a + 1; b < tubes; ++b, ++pair)
      if (distances[pair] < limit) {
        ++count[a];
        ++count[b];
      }
  return count;
}

// Median over the tubes of the distance to the nearest tube. It is the spacing of a rope, also of a slightly
// perturbed one.
double median_spacing(int tubes, const std::vector<double>& distances) {
  if (tubes < 2) return 0.0;
  std::vector<double> nearest(tubes, std::numeric_limits<double>::infinity());
  std::size_t pair = 0;
  for (int a = 0; a < tubes; ++a)
    for (int b = a + 1; b < tubes; ++b, ++pair) {
      nearest[a] = std::min(nearest[a], distances[pair]);
      nearest[b] = std::min(nearest[b], distances[pair]);
    }
  std::nth_element(nearest.begin(), nearest.begin() + tubes / 2, nearest.end());
  return nearest[tubes / 2];
}

int packing_charge(const RopeShells& shells, const std::vector<int>& neighbours) {
  int charge = 0;
  const std::size_t tubes = std::min(shells.internal.size(), neighbours.size());
  for (std::size_t t = 0; t < tubes; ++t)
    if (shells.internal[t]) charge += 6 - neighbours[t];
  return charge;
}

// The plane normal to the local rope axis. x is the projection of the space x axis (of y, if the rope lies along
// x), so that sections of successive frames have the same orientation.
struct Plane {
  Vector3 origin, x, y, normal;

  Plane(const Vector3& origin_, const Vector3& normal_) : origin(origin_), normal(normal_) {
    const Vector3 guide = std::abs(normal.x()) < 0.9 ? Vector3::UnitX() : Vector3::UnitY();
    x = (guide - guide.dot(normal) * normal).normalized();
    y = normal.cross(x);
  }
  double height(const Vector3& p) const { return (p - origin).dot(normal); }
  Vector3 local(const Vector3& v) const { return {v.dot(x), v.dot(y), v.dot(normal)}; }
};

// The point at which the bond k, k+1 of a tube passes through the plane.
std::optional<Vector3> piercing_of_bond(const Plane& plane, const State& state, int k) {
  const Vector3 p = state.position[k], q = state.position[k + 1];
  const double hp = plane.height(p), hq = plane.height(q);
  if ((hp > 0.0) == (hq > 0.0)) return std::nullopt;
  return Vector3(p + (q - p) * (hp / (hp - hq)));
}

// The point at which a tube passes through the plane, nearest to the section along the tube. The search is long
// enough for a tube inclined by 60 degrees. A tube that does not pass through the plane there (it ends, or lies in
// the plane) is projected onto it.
Vector3 piercing(const Plane& plane, const Topology& topology, const State& state, int tube, int section) {
  const int first = topology.tube_begin[tube], n = topology.length_of(tube);
  const Vector3 at = state.position[first + section];
  const double bonds_away = std::abs(plane.height(at)) / std::max(topology.type_of(tube).element_length, 1e-9);
  const int reach = 2 + static_cast<int>(std::min(2.0 * bonds_away, static_cast<double>(n)));
  for (int d = 0; d < reach; ++d)
    for (const int k : {section + d, section - 1 - d}) {
      if (k < 0 || k + 1 >= n) continue;
      if (const auto p = piercing_of_bond(plane, state, first + k)) return *p;
    }
  return at - plane.height(at) * plane.normal;
}

Vector3 along(const Vector3& tangent, const Vector3& axis) { return tangent.dot(axis) < 0.0 ? -tangent : tangent; }

// Where the tubes pass through the plane of a section, in its coordinates.
struct Pierced {
  Plane plane;
  std::vector<Vector3> points;

  std::vector<Eigen::Vector2d> in_plane() const {
    std::vector<Eigen::Vector2d> out;
    for (const Vector3& p : points) out.push_back(p.head<2>());
    return out;
  }
};
Pierced pierced_at(const Topology& topology, const State& state, int section) {
  const CentreLine line = centre_line(topology, state);
  Pierced out{Plane(line.points[section], line.tangents[section]), {}};
  for (int t = 0; t < topology.tubes(); ++t)
    out.points.push_back(out.plane.local(piercing(out.plane, topology, state, t, section) - out.plane.origin));
  return out;
}

// Radii of the tubes in a section, nm. `of` has tubes where `topology` has strands.
std::vector<double> radii_at(const Topology& of, const Topology& topology, int section) {
  std::vector<double> radii;
  for (int t = 0; t < topology.tubes(); ++t)
    radii.push_back(of.type_of(of.tube_of(topology.tube_begin[t] + section)).radius);
  return radii;
}

// Triangles between the tubes of each rope.
std::vector<Triangle> triangles_of_ropes(const Topology& topology, const std::vector<Eigen::Vector2d>& points) {
  std::vector<Triangle> triangles;
  for (int rope = 0; rope < topology.ropes(); ++rope) {
    const auto [from, behind] = topology.strands_of_rope(rope);
    for (Triangle t : delaunay({points.begin() + from, points.begin() + behind})) {
      for (int& corner : t) corner += from;
      triangles.push_back(t);
    }
  }
  return triangles;
}

// Largest radius, in spacings, of the circle through the axes of three tubes that enclose no place for a tube. The
// radius is 0.58 in a packed rope, 0.71 between four tubes in a square, and 1 about a missing tube or in a notch of
// the surface.
constexpr double widest_hole = 0.85;

double circumradius(const Triangle& t, const std::vector<Eigen::Vector2d>& points) {
  const Eigen::Vector2d u = points[t[1]] - points[t[0]], v = points[t[2]] - points[t[0]];
  const double area = 0.5 * std::fabs(u.x() * v.y() - u.y() * v.x());
  return area > 0 ? u.norm() * v.norm() * (u - v).norm() / (4 * area) : std::numeric_limits<double>::infinity();
}

double angle_at(int corner, const Triangle& t, const std::vector<Eigen::Vector2d>& points) {
  const Eigen::Vector2d at = points[t[corner]], u = points[t[(corner + 1) % 3]] - at,
                        v = points[t[(corner + 2) % 3]] - at;
  return std::atan2(std::fabs(u.x() * v.y() - u.y() * v.x()), u.dot(v));
}

}  // namespace

RopeShells rope_shells(const Topology& of, const State& reference, double neighbour_radius) {
  const Topology topology = strands_of(of);
  const int tubes = topology.tubes(), n = common_length(topology), section = n / 2;
  RopeShells shells;
  shells.internal.assign(tubes, 0);
  shells.outermost.assign(tubes, 1);
  if (n == 0) return shells;
  const double spacing = neighbour_radius > 0 ? neighbour_radius / between_shells
                                              : median_spacing(tubes, tube_distances(topology, reference, section));
  const std::vector<Eigen::Vector2d> points = pierced_at(topology, reference, section).in_plane();
  const std::vector<double> radii = radii_at(of, topology, section);
  const double gap = spacing - 2 * *std::max_element(radii.begin(), radii.end());
  std::vector<double> around(static_cast<std::size_t>(tubes), 0);
  for (const Triangle& t : triangles_of_ropes(topology, points)) {
    const double room = 2.0 / 3 * (radii[t[0]] + radii[t[1]] + radii[t[2]]) + gap;
    if (circumradius(t, points) > widest_hole * room) continue;
    for (int k = 0; k < 3; ++k) around[t[k]] += angle_at(k, t, points);
  }
  for (int t = 0; t < tubes; ++t) {
    shells.internal[t] = around[static_cast<std::size_t>(t)] > 2 * units::pi - 1e-6;
    shells.outermost[t] = !shells.internal[t];
  }
  return shells;
}

CrossSection cross_section(const Topology& of, const State& state, const RopeShells& shells, int section,
                           double neighbour_radius, double spacing) {
  CrossSection out;
  const Topology topology = strands_of(of);
  const int tubes = topology.tubes(), n = common_length(topology);
  if (n == 0) return out;
  section = std::clamp(section, 0, n - 1);
  out.neighbours =
      neighbours_within(tubes, tube_distances(topology, state, section), limit_of(neighbour_radius, spacing));
  for (const int count : out.neighbours) out.contacts += count;
  out.contacts /= 2;
  out.charge = packing_charge(shells, out.neighbours);

  const Pierced pierced = pierced_at(topology, state, section);
  out.points = pierced.in_plane();
  out.radii = radii_at(of, topology, section);
  std::vector<Vector3> tangents;
  for (int t = 0; t < tubes; ++t) {
    tangents.push_back(pierced.plane.local(along(tube_tangent(topology, state, t, section), pierced.plane.normal)));
  }
  const std::vector<Triangle> triangles = triangles_of_ropes(topology, out.points);
  out.delaunay = edge_counts(triangles, tubes);
  if (!triangles.empty()) out.charge_delaunay = packing_charge(shells, out.delaunay);
  const Voids voids = find_voids(triangles, pierced.points, tangents, spacing);
  out.voids = voids.count;
  out.void_area = voids.area;
  return out;
}

}  // namespace ropewalk
