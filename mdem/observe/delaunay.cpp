#include "observe/delaunay.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <utility>

extern "C" {
#include <libqhull_r/qhull_ra.h>
}

namespace ropewalk {
namespace {

using Eigen::Vector2d;

double cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

// Qhull prints to a FILE of its caller, or to stderr if it is given none.
struct Sink {
  std::FILE* file = std::fopen("/dev/null", "w");
  Sink() = default;
  Sink(const Sink&) = delete;
  Sink& operator=(const Sink&) = delete;
  ~Sink() {
    if (file) std::fclose(file);
  }
};

// One call of Qhull. The destructor releases its memory, also after an error: Qhull then returns by longjmp into
// qh_new_qhull, which gives the exit code.
class QhullCall {
 public:
  explicit QhullCall(std::FILE* sink) : qh_(std::make_unique<qhT>()) { qh_zero(qh_.get(), sink); }
  QhullCall(const QhullCall&) = delete;
  QhullCall& operator=(const QhullCall&) = delete;
  ~QhullCall() {
    int left = 0, total = 0;
    qh_freeqhull(qh_.get(), !qh_ALL);
    qh_memfreeshort(qh_.get(), &left, &total);
  }

  bool run(std::vector<coordT>& coordinates, std::string options, std::FILE* sink) {
    const int points = static_cast<int>(coordinates.size() / 2);
    return qh_new_qhull(qh_.get(), 2, points, coordinates.data(), False, options.data(), sink, sink) == 0;
  }

  std::vector<Triangle> lower_facets() {
    qhT* qh = qh_.get();
    std::vector<Triangle> found;
    facetT* facet;
    FORALLfacets {
      if (facet->upperdelaunay || !facet->simplicial) continue;
      Triangle corner{-1, -1, -1};
      int n = 0;
      vertexT *vertex, **vertexp;
      FOREACHvertex_(facet->vertices) {
        if (n < 3) corner[n] = qh_pointid(qh, vertex->point);
        ++n;
      }
      const bool real = std::all_of(corner.begin(), corner.end(), [](int id) { return id >= 0; });
      if (n == 3 && real) found.push_back(corner);
    }
    return found;
  }

 private:
  std::unique_ptr<qhT> qh_;
};

// Makes the triangle counter-clockwise; returns false if it has no area.
bool orient(const std::vector<Vector2d>& points, Triangle& t) {
  const Vector2d u = points[t[1]] - points[t[0]], v = points[t[2]] - points[t[0]];
  const double twice_area = cross(u, v);
  if (twice_area < 0.0) std::swap(t[1], t[2]);
  const double longest = std::max({u.squaredNorm(), v.squaredNorm(), (u - v).squaredNorm()});
  return std::abs(twice_area) > 1e-10 * longest;
}

bool triangulate(const std::vector<Vector2d>& points, const std::string& options, std::vector<Triangle>& out) {
  const Sink sink;
  if (!sink.file) return false;
  std::vector<coordT> coordinates;
  for (const Vector2d& p : points) coordinates.insert(coordinates.end(), {p.x(), p.y()});
  QhullCall call(sink.file);
  if (!call.run(coordinates, options, sink.file)) return false;
  out = call.lower_facets();
  return true;
}

}  // namespace

std::vector<Triangle> delaunay(const std::vector<Vector2d>& points) {
  std::vector<Triangle> triangles;
  if (points.size() < 4) return triangles;
  for (const Vector2d& p : points)
    if (!p.allFinite()) return triangles;
  // Qt makes triangles also if more than three points share a circle. If all points share one circle, the lifted
  // hull is flat; Qz then adds a point at infinity.
  if (!triangulate(points, "qhull d Qt Qbb Qc", triangles) &&
      !triangulate(points, "qhull d Qt Qbb Qc Qz", triangles))
    return {};
  std::vector<Triangle> kept;
  for (Triangle t : triangles) {
    const bool inside = *std::max_element(t.begin(), t.end()) < static_cast<int>(points.size());  // not Qz's point
    if (inside && orient(points, t)) kept.push_back(t);
  }
  return kept;
}

std::vector<int> edge_counts(const std::vector<Triangle>& triangles, int points) {
  std::vector<std::pair<int, int>> edges;
  for (const Triangle& t : triangles)
    for (int k = 0; k < 3; ++k) edges.push_back(std::minmax({t[k], t[(k + 1) % 3]}));
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  std::vector<int> counts(points, 0);
  for (const auto& [i, j] : edges) {
    ++counts[i];
    ++counts[j];
  }
  return counts;
}

}  // namespace ropewalk
