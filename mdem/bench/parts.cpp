#include "bench/parts.hpp"

#include <algorithm>
#include <memory>
#include <numeric>

#include "io/clocks.hpp"
#include "sim/dynamics/simulation.hpp"
#include "sim/state/part_of_scene.hpp"
#include "sim/threads/threads.hpp"

namespace ropewalk {
namespace {

struct Box {
  Vector3 low = Vector3::Constant(1e300), high = -low;
  void take(const Vector3& x) {
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
  }
};

Box box_of(const State& s, const int* from, const int* to) {
  Box box;
  for (; from != to; ++from) box.take(s.position[static_cast<std::size_t>(*from)]);
  return box;
}

// Halves the elements from `from` to `to` until there are `parts`.
void cut(const State& s, bool across_z, int parts, int* from, int* to, std::vector<std::vector<int>>& out) {
  if (parts == 1) {
    out.emplace_back(from, to);
    std::sort(out.back().begin(), out.back().end());
    return;
  }
  Eigen::Index axis = 2;
  const Box box = box_of(s, from, to);
  if (!across_z) (box.high - box.low).maxCoeff(&axis);
  int* middle = from + (to - from) / 2;
  std::nth_element(from, middle, to, [&](int a, int b) {
    return s.position[static_cast<std::size_t>(a)][axis] < s.position[static_cast<std::size_t>(b)][axis];
  });
  cut(s, across_z, parts / 2, from, middle, out);
  cut(s, across_z, parts / 2, middle, to, out);
}

// One part of a scene, ready to be computed.
class Part {
 public:
  Part(const Topology& scene, const Interaction& in, const State& s, const std::vector<int>& own)
      : in_(in), list_(in, default_skin(in)) {
    Box box = box_of(s, own.data(), own.data() + own.size());
    const double reach = copy_reach(scene, in, list_.skin);
    box.low.array() -= reach;
    box.high.array() += reach;
    std::vector<int> number;
    std::vector<char> owned;
    auto next = own.begin();
    for (int i = 0; i < scene.elements(); ++i) {
      const bool mine = next != own.end() && *next == i;
      const Vector3 x = s.position[static_cast<std::size_t>(i)];
      if (mine) ++next;
      if (!mine && !((x - box.low).minCoeff() > 0 && (box.high - x).minCoeff() > 0)) continue;
      number.push_back(i);
      owned.push_back(mine);
    }
    state_ = part_of_state(s, number);
    cost_.own = static_cast<int>(own.size());
    cost_.copies = static_cast<int>(number.size() - own.size());
    cost_.seconds = 1e300;
    topology_ = part_of_scene(scene, std::move(number), std::move(owned));
    list_.build(topology_, state_);
    cost_.pairs = static_cast<double>(list_.pairs());
    forces_ = Forces(state_.size());
  }

  void measure() {
    constexpr int in_a_row = 3;  // the first one fills the caches
    for (int k = 0; k < in_a_row; ++k) {
      const double began = processor_seconds();
      engine_.compute(topology_, in_, list_, state_, forces_);
      cost_.seconds = std::min(cost_.seconds, processor_seconds() - began);
    }
  }
  const PartCost& cost() const { return cost_; }

 private:
  const Interaction& in_;
  Topology topology_;
  State state_;
  NeighbourList list_;
  ForceEngine engine_;
  Forces forces_;
  PartCost cost_;
};

constexpr int rounds = 15;

}  // namespace

std::vector<std::vector<PartCost>> cost_of_parts(const Topology& topology, const Interaction& interaction,
                                                 const State& state, int most, bool across_z) {
  use_threads(1);
  std::vector<std::vector<std::unique_ptr<Part>>> cuts;
  for (int n = 1; n <= most; n *= 2) {
    std::vector<int> all(static_cast<std::size_t>(topology.elements()));
    std::iota(all.begin(), all.end(), 0);
    std::vector<std::vector<int>> owned;
    cut(state, across_z, n, all.data(), all.data() + all.size(), owned);
    cuts.emplace_back();
    for (const std::vector<int>& own : owned)
      cuts.back().push_back(std::make_unique<Part>(topology, interaction, state, own));
  }
  for (int round = 0; round < rounds; ++round)
    for (const auto& parts : cuts)
      for (const auto& part : parts) part->measure();
  std::vector<std::vector<PartCost>> out;
  for (const auto& parts : cuts) {
    out.emplace_back();
    for (const auto& part : parts) out.back().push_back(part->cost());
  }
  return out;
}

ElementCost fit(const std::vector<std::vector<PartCost>>& cuts) {
  Eigen::Matrix2d a = Eigen::Matrix2d::Zero();
  Eigen::Vector2d b = Eigen::Vector2d::Zero();
  for (const auto& parts : cuts)
    for (const PartCost& p : parts) {
      const Eigen::Vector2d row = Eigen::Vector2d(p.own, p.copies) / p.seconds;
      a += row * row.transpose();
      b += row;
    }
  const double determinant = a.determinant();
  if (!(determinant > 1e-12 * a(0, 0) * a(1, 1))) return {b[0] / a(0, 0), 0};  // nothing was cut
  const Eigen::Vector2d found = a.inverse() * b;
  return {found[0], found[1]};
}

}  // namespace ropewalk
