// The network of tubes that touch: their contacts, and clusters of them. From topology and state alone, so that
// stored frames give the same.
#pragma once

#include <array>
#include <utility>
#include <vector>

#include "sim/state/state.hpp"

namespace ropewalk {

// Two tubes, the lower number first.
using TubePair = std::pair<int, int>;

// The pairs of tubes whose axes are closer than `distance` (nm), each once, in the order of their numbers.
std::vector<TubePair> touching_tubes(const Topology& topology, const State& state, double distance);

// Sets of tubes that hang together by contacts. A cluster spans in x if it reaches from x = -reach[0] to
// x = reach[0], and likewise in y.
class TubeClusters {
 public:
  // Each tube is a cluster by itself. `reach` in nm.
  TubeClusters(const Topology& topology, const State& state, std::array<double, 2> reach);
  void join(const TubePair& pair);

  int largest() const { return largest_; }  // the number of its tubes
  bool spans_x() const { return spans_[0]; }
  bool spans_y() const { return spans_[1]; }

 private:
  struct Cluster {
    int tubes = 1;
    std::array<double, 2> from{}, to{};  // nm, how far its elements reach in x and y
  };

  std::size_t cluster_of(int tube);
  void look_at(const Cluster& cluster);

  std::array<double, 2> reach_;
  std::vector<std::size_t>
      parent_;  // another tube of the cluster of each tube, in the end the one that stands for the cluster
  std::vector<Cluster> clusters_;  // clusters of the tubes that stand for one
  int largest_ = 1;
  std::array<bool, 2> spans_{};
};

// All of a film or of another random network.
struct TubeNetwork {
  double contacts = 0;                    // mean number of contacts of a tube with others
  double largest = 0;                     // the part of all tubes that are in the largest cluster
  bool spans_x = false, spans_y = false;  // some cluster does, see TubeClusters
};
TubeNetwork tube_network(const Topology& topology, const State& state, double distance,
                         std::array<double, 2> reach);

}  // namespace ropewalk
