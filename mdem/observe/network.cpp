#include "observe/network.hpp"

#include <algorithm>

#include "model/segments.hpp"
#include "sim/neighbours/cell_grid.hpp"

namespace ropewalk {
namespace {

struct Element {
  int tube;
  Vector3 place, axis;
  double half;  // half of its length, nm

  Element(const Topology& topology, const State& state, int element, int of)
      : tube(of),
        place(state.position[static_cast<std::size_t>(element)]),
        axis(axis_of(state.orientation[static_cast<std::size_t>(element)])),
        half(0.5 * topology.type_of(of).element_length) {}
};

}  // namespace

std::vector<TubePair> touching_tubes(const Topology& topology, const State& state, double distance) {
  const CellGrid grid(state.position, distance + topology.longest_element());
  std::vector<TubePair> pairs;
  std::vector<int> near;
  for (int tube = 0; tube < topology.tubes(); ++tube) {
    const int begin = topology.tube_begin[tube], end = topology.tube_begin[tube + 1];
    for (int i = begin; i < end; ++i) {
      const Element one(topology, state, i, tube);
      const std::size_t count = grid.find(i, end - 1, near);
      for (std::size_t k = 0; k < count; ++k) {
        const Element other(topology, state, near[k], topology.tube_of(near[k]));
        if (squared_segment_distance(other.place - one.place, one.axis, other.axis, one.half, other.half) <
            distance * distance)
          pairs.emplace_back(tube, other.tube);
      }
    }
  }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  return pairs;
}

TubeClusters::TubeClusters(const Topology& topology, const State& state, std::array<double, 2> reach)
    : reach_(reach), clusters_(static_cast<std::size_t>(topology.tubes())) {
  const std::array<const Column*, 2> place = {&state.position.x, &state.position.y};
  for (std::size_t t = 0; t < clusters_.size(); ++t) {
    parent_.push_back(t);
    for (std::size_t side = 0; side < 2; ++side) {
      const auto [least, most] = std::minmax_element(place[side]->begin() + topology.tube_begin[t],
                                                     place[side]->begin() + topology.tube_begin[t + 1]);
      clusters_[t].from[side] = *least;
      clusters_[t].to[side] = *most;
    }
    look_at(clusters_[t]);
  }
}

std::size_t TubeClusters::cluster_of(int tube) {
  auto at = static_cast<std::size_t>(tube);
  while (parent_[at] != at) at = parent_[at] = parent_[parent_[at]];
  return at;
}

void TubeClusters::look_at(const Cluster& cluster) {
  largest_ = std::max(largest_, cluster.tubes);
  for (std::size_t side = 0; side < 2; ++side)
    spans_[side] = spans_[side] || (cluster.from[side] <= -reach_[side] && cluster.to[side] >= reach_[side]);
}

void TubeClusters::join(const TubePair& pair) {
  std::size_t into = cluster_of(pair.first), from = cluster_of(pair.second);
  if (into == from) return;
  if (clusters_[into].tubes < clusters_[from].tubes) std::swap(into, from);
  parent_[from] = into;
  Cluster &kept = clusters_[into], &other = clusters_[from];
  kept.tubes += other.tubes;
  for (std::size_t side = 0; side < 2; ++side) {
    kept.from[side] = std::min(kept.from[side], other.from[side]);
    kept.to[side] = std::max(kept.to[side], other.to[side]);
  }
  look_at(kept);
}

TubeNetwork tube_network(const Topology& topology, const State& state, double distance,
                         std::array<double, 2> reach) {
  const std::vector<TubePair> pairs = touching_tubes(topology, state, distance);
  TubeClusters clusters(topology, state, reach);
  for (const TubePair& pair : pairs) clusters.join(pair);
  const double tubes = topology.tubes();
  return {2 * static_cast<double>(pairs.size()) / tubes, clusters.largest() / tubes, clusters.spans_x(),
          clusters.spans_y()};
}

}  // namespace ropewalk
