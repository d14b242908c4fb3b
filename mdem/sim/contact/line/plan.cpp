#include "sim/contact/line/plan.hpp"

#include <numeric>
#include <utility>

namespace ropewalk {

void LinePlan::start(const Topology& topology, const NeighbourList& list, const LineList& runs) {
  wanted_ = static_cast<double>(runs.split_runs()) > worth * topology.elements();
  list_turned_ = list.turn();
  list_moved_ = 2 * list.displacement();
  within_ = list.within();
  lever_ = list.lever;
  if (!wanted_ || stamp_ != list.stamp()) use_ = Use::none;
  stamp_ = list.stamp();
  changes_.resize(static_cast<std::size_t>(topology.tubes()));
  chunks_.resize(runs.chunks().size());
}

void LinePlan::look(const Topology& topology, const State& state, int tube) {
  if (use_ == Use::none) return;
  changes_[static_cast<std::size_t>(tube)] =
      since_.change(state, lever_, topology.tube_begin[tube], topology.tube_begin[tube + 1]);
}

bool LinePlan::holds() {
  if (use_ == Use::none) return false;
  const MotionSince::Bound bound =
      since_.bound(std::accumulate(changes_.begin(), changes_.end(), Change{}, both), within_, lever_);
  return bound.moved <= motion && bound.turned <= turn && list_turned_ <= turned_ && list_moved_ <= moved_;
}

void LinePlan::choose(const State& state, const Vec3Array& axis) {
  if (!wanted_) {
    turned_ = list_turned_;
    moved_ = list_moved_;
  } else if (resumes_) {
    use_ = Use::record;
  } else if (holds()) {
    use_ = Use::replay;
  } else {
    use_ = Use::record;
    turned_ = list_turned_ + turn;
    moved_ = list_moved_ + motion_room;
    since_.start(state.position, axis);
  }
  resumes_ = false;
}

void LinePlan::resume(const NeighbourList& list, Saved saved) {
  resumes_ = true;
  stamp_ = list.stamp();
  turned_ = saved.turned;
  moved_ = saved.moved;
  since_.start(std::move(saved.position), std::move(saved.axis));
  since_.set_twist(saved.twist);
}

std::size_t LinePlan::bytes() const {
  std::size_t total = since_.bytes();
  for (const ChunkPlan& c : chunks_) {
    total += c.rows.capacity() * sizeof(NodeRow) + c.elements.capacity() * sizeof(ChunkPlan::Element);
    for (const AlikePairs& of : c.pairs) total += of.pairs.capacity() * sizeof(AlikePairs::Pair);
  }
  return total;
}

}  // namespace ropewalk
