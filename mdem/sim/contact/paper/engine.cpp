#include "sim/contact/paper/engine.hpp"

#include <omp.h>

#include <algorithm>
#include <cmath>

namespace ropewalk {
template <class T>
void PaperElements<T>::place(const Vec3Array& position, const Vec3Array& axis, std::size_t begin, std::size_t end) {
  const double per_unit = 1 / unit;
  const auto coordinate = [&](double v) {
    if constexpr (sizeof(T) == 4) return static_cast<Coordinate>(std::lrint(v * per_unit));
    return static_cast<Coordinate>(v);
  };
  for (std::size_t i = begin; i < end; ++i) {
    x[i] = coordinate(position.x[i]);
    y[i] = coordinate(position.y[i]);
    z[i] = coordinate(position.z[i]);
    nx[i] = static_cast<T>(axis.x[i]);
    ny[i] = static_cast<T>(axis.y[i]);
    nz[i] = static_cast<T>(axis.z[i]);
  }
}

template <class T>
void PaperEngine::run(PaperElements<T>& elements, const Interaction& in, const NeighbourList& list,
                      const State& state, const Vec3Array& axis, ContactBuffer<double>* buffers, bool energies) {
  const auto n = static_cast<std::ptrdiff_t>(state.size());
  constexpr std::ptrdiff_t block = 512;
  elements.resize(state.size());
#pragma omp parallel for schedule(static) if (state.size() > parallel_from)
  for (std::ptrdiff_t i = 0; i < n; i += block)
    elements.place(state.position, axis, static_cast<std::size_t>(i),
                   static_cast<std::size_t>(std::min(i + block, n)));
  const PaperKernelInput<T> input{&*in.paper, &elements, &axis, &runs_, in.legacy_torque, energies};
#pragma omp parallel for schedule(dynamic, 1) if (state.size() > parallel_from)
  for (std::size_t k = 0; k < list.chunks().size(); ++k) {
    const NeighbourList::Chunk& chunk = list.chunks()[k];
    buffers[k].clear(static_cast<std::size_t>(chunk.touched_end - chunk.touched_begin));
    paper_contact(input, chunk, buffers[k]);
    if (in.damped_contact()) contact_damping(in.damping.contact, state, damped_[k], buffers[k]);
  }
}

void PaperEngine::list_damped(const Topology& topology, const Interaction& in, const NeighbourList& list) {
  PairRuns near;
  near.build(list, in.damping.contact.outer);
  damped_.clear();
  for (const NeighbourList::Chunk& chunk : list.chunks()) {
    DampedBlocks blocks;
    for (int i = chunk.begin; i < chunk.end; ++i) {
      const TouchedRange own{i, std::min(chunk.end, topology.tube_begin[topology.tube_of(i) + 1]),
                             -chunk.touched_begin};
      for (const PairRun& run : near.runs(i))
        for_tubes_of(topology, run, [&](int tube, int from, int to) {
          blocks.add(i, own, from, to,
                     {std::max(topology.tube_begin[tube], chunk.touched_begin),
                      std::min(topology.tube_begin[tube + 1], chunk.touched_end), -chunk.touched_begin});
        });
    }
    damped_.push_back(blocks.take());
  }
}

void PaperEngine::compute(const Topology& topology, const Interaction& in, const NeighbourList& list,
                          const State& state, const Vec3Array& axis, ContactBuffer<double>* buffers,
                          bool energies) {
  if (stamp_ != list.stamp()) {
    const double began = omp_get_wtime();
    runs_.build(list, in.paper->cutoff());
    if (in.damped_contact()) list_damped(topology, in, list);
    mixed_.unit = list.coordinate_unit();
    stamp_ = list.stamp();
    list_seconds_ += omp_get_wtime() - began;
  }
  if (in.precision == Interaction::Precision::full) {
    run(full_, in, list, state, axis, buffers, energies);
  } else {
    run(mixed_, in, list, state, axis, buffers, energies);
  }
}

std::size_t PaperEngine::bytes() const {
  const auto of = [](const auto& e) {
    return 3 * (e.x.capacity() * sizeof(e.x[0]) + e.nx.capacity() * sizeof(e.nx[0]));
  };
  std::size_t damped = 0;
  for (const auto& blocks : damped_) damped += blocks.capacity() * sizeof(DampedBlock);
  return runs_.bytes() + damped + of(mixed_) + of(full_);
}

}  // namespace ropewalk
