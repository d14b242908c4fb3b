#include "sim/contact/shared/buffered_engine.hpp"

#include <omp.h>

#include <algorithm>

#include "model/contract.hpp"
#include "sim/contact/shared/neighbour_spans.hpp"
#include "sim/threads/for_each.hpp"

namespace ropewalk {

namespace {

// The pairs of a chunk, from the spans of elements that come near.
class SpanPairs : public ChunkPairs {
 public:
  SpanPairs(const Topology& topology, const ElementSpans& near, const NeighbourList::Chunk& chunk)
      : topology_(topology), near_(near), chunk_(chunk) {}

  int entries() const override { return chunk_.written_end - chunk_.written_begin; }
  void each(const std::function<void(const NearElements&)>& visit) const override {
    for (int i = chunk_.begin; i < chunk_.end; ++i) {
      if (!topology_.owns(i)) continue;
      const int tube = topology_.tube_of(i), end = std::min(chunk_.end, topology_.tube_begin[tube + 1]),
                own_end = topology_.part ? topology_.change_of_owner(i, end) : end;
      for (const ElementSpan& span : near_.spans(i))
        for_tubes_of(topology_, span, [&](int tube_j, int from, int to) {
          visit({i, written(tube), own_end, from, to, written(tube_j)});
        });
    }
  }

 private:
  BufferRange written(int tube) const {
    return {std::max(topology_.tube_begin[tube], chunk_.written_begin),
            std::min(topology_.tube_begin[tube + 1], chunk_.written_end), -chunk_.written_begin};
  }

  const Topology& topology_;
  const ElementSpans& near_;
  const NeighbourList::Chunk& chunk_;
};

}  // namespace

void BufferedEngine::list_pairs(const ContactInput& in, PairWork& pairs) const {
  ElementSpans near;
  near.build(in.list, pairs.reach());
  const auto& chunks = in.list.chunks();
  pairs.start(chunks.size());
  for (std::size_t k = 0; k < chunks.size(); ++k) pairs.list(k, SpanPairs(in.topology, near, chunks[k]));
}

void BufferedEngine::compute(const Topology& topology, const Interaction& interaction, const NeighbourList& list,
                             const State& state, const Vec3Array& axis, bool /*energies*/, const TubeWork& tubes) {
  ROPEWALK_EXPECTS(axis.size() == state.size());
  const bool parallel = state.size() > parallel_from;
  const ContactInput in{topology, interaction, list, state, axis};
  list_ = &list;
  parts_ = &tubes.parts;
  if (stamp_ != list.stamp()) {
    const double began = omp_get_wtime();
    update_list(in);
    if (tubes.pairs) list_pairs(in, *tubes.pairs);
    stamp_ = list.stamp();
    list_seconds_ += omp_get_wtime() - began;
  }
  for_each(topology.tubes(), parallel, [&](int t) { tubes.place(t); });
  prepare(in);
  buffers_.resize(list.chunks().size());
  for_each_uneven(list.chunks().size(), std::size_t{1}, parallel, [&](std::size_t k) {
    const NeighbourList::Chunk& chunk = list.chunks()[k];
    buffers_[k].clear(static_cast<std::size_t>(chunk.written_end - chunk.written_begin));
    add_chunk(in, chunk, buffers_[k]);
    if (tubes.pairs) tubes.pairs->add(k, buffers_[k]);
  });
  const double began = omp_get_wtime();
  for_each(tubes.parts.blocks(), parallel, [&](int block) { tubes.finish(block); });
  finish_seconds_ += omp_get_wtime() - began;
}

void BufferedEngine::add_to(int part, const ForceRows& out) const {
  ROPEWALK_EXPECTS(list_ && parts_ && buffers_.size() == list_->chunks().size());
  const Segment& of = (*parts_)[part];
  for (std::size_t k = 0; k < list_->chunks().size(); ++k) {
    const auto& chunk = list_->chunks()[k];
    const ContactBuffer<double>& b = buffers_[k];
    const int low = std::max(of.begin, chunk.written_begin), high = std::min(of.end, chunk.written_end);
    for (int i = low; i < high; ++i) {
      const auto at = static_cast<std::size_t>(i - chunk.written_begin),
                 to_row = static_cast<std::size_t>(i - out.origin);
      out.force.x[to_row] += b.fx[at];
      out.force.y[to_row] += b.fy[at];
      out.force.z[to_row] += b.fz[at];
      out.torque.x[to_row] += b.tx[at];
      out.torque.y[to_row] += b.ty[at];
      out.torque.z[to_row] += b.tz[at];
    }
  }
}

double BufferedEngine::energy() const {
  double sum = 0;
  for (const ContactBuffer<double>& b : buffers_) sum += b.energy;
  return sum;
}

std::size_t BufferedEngine::bytes() const {
  std::size_t total = 0;
  for (const ContactBuffer<double>& b : buffers_) total += b.bytes();
  return total;
}

double BufferedEngine::step_bytes(const NeighbourList& list, std::size_t) const {
  double sum = 0;
  for (const NeighbourList::Chunk& chunk : list.chunks())
    sum += buffer_bytes(chunk.written_end - chunk.written_begin, sizeof(double));
  return sum;
}

}  // namespace ropewalk
