#include "sim/contact/shared/buffered_engine.hpp"

#include <omp.h>

#include <algorithm>

#include "sim/contact/shared/neighbour_spans.hpp"

namespace ropewalk {

void BufferedEngine::list_damped(const ContactInput& in) {
  const Topology& topology = in.topology;
  ElementSpans near;
  near.build(in.list, in.interaction.damping.contact.outer);
  damped_.clear();
  for (const NeighbourList::Chunk& chunk : in.list.chunks()) {
    DampedBlocks blocks;
    for (int i = chunk.begin; i < chunk.end; ++i) {
      if (!topology.owns(i)) continue;
      const int end = std::min(chunk.end, topology.tube_begin[topology.tube_of(i) + 1]);
      const BufferRange own{i, topology.part ? topology.change_of_owner(i, end) : end, -chunk.written_begin};
      for (const ElementSpan& span : near.spans(i))
        for_tubes_of(topology, span, [&](int tube, int from, int to) {
          blocks.add(i, own, from, to,
                     {std::max(topology.tube_begin[tube], chunk.written_begin),
                      std::min(topology.tube_begin[tube + 1], chunk.written_end), -chunk.written_begin});
        });
    }
    damped_.push_back(blocks.take());
  }
}

void BufferedEngine::compute(const Topology& topology, const Interaction& interaction, const NeighbourList& list,
                             const State& state, const Vec3Array& axis, bool /*energies*/, const TubeWork& tubes) {
  const bool parallel = state.size() > parallel_from;
  const ContactInput in{topology, interaction, list, state, axis};
  list_ = &list;
  parts_ = &tubes.parts;
  if (stamp_ != list.stamp()) {
    const double began = omp_get_wtime();
    update_list(in);
    if (interaction.damped_contact()) list_damped(in);
    stamp_ = list.stamp();
    list_seconds_ += omp_get_wtime() - began;
  }
#pragma omp parallel for schedule(static) if (parallel)
  for (int t = 0; t < topology.tubes(); ++t) tubes.place(t);
  prepare(in);
  buffers_.resize(list.chunks().size());
#pragma omp parallel for schedule(dynamic, 1) if (parallel)
  for (std::size_t k = 0; k < list.chunks().size(); ++k) {
    const NeighbourList::Chunk& chunk = list.chunks()[k];
    buffers_[k].clear(static_cast<std::size_t>(chunk.written_end - chunk.written_begin));
    add_chunk(in, chunk, buffers_[k]);
    if (interaction.damped_contact()) contact_damping(interaction.damping.contact, state, damped_[k], buffers_[k]);
  }
  const double began = omp_get_wtime();
#pragma omp parallel for schedule(static) if (parallel)
  for (int block = 0; block < tubes.parts.blocks(); ++block) tubes.finish(block);
  finish_seconds_ += omp_get_wtime() - began;
}

void BufferedEngine::add_to(int part, const ForceRows& out) const {
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

double BufferedEngine::damping_power() const {
  double sum = 0;
  for (const ContactBuffer<double>& b : buffers_) sum += b.power;
  return sum;
}

std::size_t BufferedEngine::bytes() const {
  std::size_t total = 0;
  for (const ContactBuffer<double>& b : buffers_) total += b.bytes();
  for (const auto& blocks : damped_) total += blocks.capacity() * sizeof(DampedBlock);
  return total;
}

double BufferedEngine::step_bytes(const NeighbourList& list, std::size_t) const {
  double sum = 0;
  for (const NeighbourList::Chunk& chunk : list.chunks())
    sum += buffer_bytes(chunk.written_end - chunk.written_begin, sizeof(double));
  return sum;
}

}  // namespace ropewalk
