#include "observe/spacing.hpp"

#include <algorithm>
#include <limits>

namespace ropewalk {
namespace {

Vector3 middle_of(const Topology& topology, const State& state, int tube) {
  const int n = topology.length_of(tube), first = topology.tube_begin[tube];
  return 0.5 * (state.position[first + (n - 1) / 2] + state.position[first + n / 2]);
}

// Distance of a point from the polyline through the elements of a tube.
double distance_to(const Topology& topology, const State& state, int tube, const Vector3& point) {
  double least = std::numeric_limits<double>::infinity();
  for (int i = topology.tube_begin[tube]; i + 1 < topology.tube_begin[tube + 1]; ++i) {
    const Vector3 from = state.position[i], along = Vector3(state.position[i + 1]) - from;
    const double at = std::clamp(along.dot(point - from) / along.squaredNorm(), 0.0, 1.0);
    least = std::min(least, (from + at * along - point).norm());
  }
  return least;
}

}  // namespace

double tube_spacing(const Topology& of, const State& state, const RopeShells& shells) {
  const Topology topology = strands_of(of);
  const bool rope = topology.tubes() > 2;
  double sum = 0;
  int count = 0;
  for (int t = 0; t < topology.tubes(); ++t) {
    if (rope && !shells.internal[static_cast<std::size_t>(t)]) continue;
    const Vector3 middle = middle_of(topology, state, t);
    std::vector<double> distances;
    for (int other = 0; other < topology.tubes(); ++other)
      if (other != t) distances.push_back(distance_to(topology, state, other, middle));
    std::sort(distances.begin(), distances.end());
    const std::size_t nearest = std::min<std::size_t>(6, distances.size());
    for (std::size_t k = 0; k < nearest; ++k) sum += distances[k];
    count += static_cast<int>(nearest);
  }
  return count > 0 ? sum / count : 0;
}

}  // namespace ropewalk
