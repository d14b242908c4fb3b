#include "sim/contact/line/engine.hpp"

#include <omp.h>

#include "sim/threads/for_each.hpp"
#include "sim/threads/vector_unit.hpp"

#define ROPEWALK_LOOPS "sim/contact/line/buffer_loops-inl.hpp"
#include "sim/threads/for_each_vector_unit-inl.hpp"

namespace ropewalk {
namespace {

template <class Buffers>
void make_tables(Buffers& b, const LineLaw& law, double unit) {
  if (b.unit == unit && !b.pairs.empty()) return;
  b.pairs.clear();
  for (const LineContact& pair : law.pairs) b.pairs.emplace_back(pair, unit);
  b.unit = unit;
}

void add_range(const BufferRange& of, const ContactBuffer<float>& b, const ForceRows& sums) {
  ROPEWALK_IN_USE(add_floats)(of, b, sums);
}
void add_range(const BufferRange& of, const ContactBuffer<double>& b, const ForceRows& sums) {
  ROPEWALK_IN_USE(add_doubles)(of, b, sums);
}

}  // namespace

void LineEngine::update_list(const Topology& topology, const Interaction& in, const NeighbourList& list,
                             const TubeWork& tubes) {
  if (stamp_ == list.stamp()) return;
  const double began = omp_get_wtime();
  list_.build(topology, in, list, tubes.pairs);
  stamp_ = list.stamp();
  full_ = in.precision == Interaction::Precision::full;
  offsets_.clear();
  const LineLaw& law = line_law_of(in);
  for (int a = 0; a < static_cast<int>(topology.types.size()); ++a)
    offsets_.push_back(node_offsets(list_.nodes_per_element(a), law.of({a, 0}).length_i));
  written_.list(tubes.parts, list_.chunks());
  if (full_) {
    make_tables(full_buffers_, law, 1);
  } else {
    make_tables(mixed_, law, list_.unit());
  }
  list_seconds_ += omp_get_wtime() - began;
}

// One thread computes the positions of the nodes, what acts on them, and what acts on their elements.
template <class Buffers>
void LineEngine::compute_chunk(std::size_t k, std::size_t thread, PairWork* pairs, Buffers& b,
                               KernelInput<Buffers> in) {
  const LineChunk& chunk = list_.chunks()[k];
  auto& work = b.work[thread];
  auto& out = b.of_chunks[k];
  const NodeInput elements{chunk, in.topology->tube_type, offsets_, in.state->position, *in.axis};
  position_nodes(elements, b.unit, b.nodes[thread]);
  in.nodes = &b.nodes[thread];
  out.clear(static_cast<std::size_t>(chunk.elements));
  if (pairs) pairs->add(k, out);
  work.forces.clear(chunk.nodes);
  line_contact(in, chunk, work, out);
  add_node_forces(elements, work.forces, out);
}

template <class Buffers>
void LineEngine::compute_all(Buffers& b, const Topology& topology, const NeighbourList& list, const State& state,
                             const Vec3Array& axis, bool energies, const TubeWork& tubes) {
  const bool parallel = state.size() > parallel_from, at_once = state.size() > finish_at_once_from;
  const int threads = parallel ? threads_in_use() : 1;
  const KernelInput<Buffers> input{
      &topology, &state, &axis, &list_, nullptr, b.pairs.data(), b.unit, 1 / b.unit, 2 * list.displacement(),
      energies};
  b.of_chunks.resize(list_.chunks().size());
  b.nodes.resize(static_cast<std::size_t>(threads));
  b.work.resize(static_cast<std::size_t>(threads));
  for (auto& nodes : b.nodes) nodes.reserve(list_.largest().nodes);
  for (auto& work : b.work) work.found.reserve(list_.largest().vectors);
  left_.start(written_.chunks_on());
  const auto finish = [&](int block) {
    if (omp_get_thread_num() != 0) return tubes.finish(block);
    const double began = omp_get_wtime();
    tubes.finish(block);
    finish_seconds_ += omp_get_wtime() - began;
  };
  shares_.deal(static_cast<int>(list_.chunks().size()), threads);
  in_team(parallel, [&] {
#pragma omp for schedule(static)
    for (int t = 0; t < topology.tubes(); ++t) tubes.place(t);
    const int thread = omp_get_thread_num();
    for (int piece; (piece = shares_.take(thread)) >= 0;) {
      const auto k = static_cast<std::size_t>(piece);
      compute_chunk(k, static_cast<std::size_t>(thread), tubes.pairs, b, input);
      if (at_once)
        for (int block : written_.blocks(k))
          if (left_.last(block)) finish(block);
    }
#pragma omp barrier
#pragma omp for schedule(static)
    for (int block = 0; block < tubes.parts.blocks(); ++block)
      if (!at_once || written_.chunks_on()[static_cast<std::size_t>(block)] == 0) finish(block);
  });
}

void LineEngine::compute(const Topology& topology, const Interaction& in, const NeighbourList& list,
                         const State& state, const Vec3Array& axis, bool energies, const TubeWork& tubes) {
  update_list(topology, in, list, tubes);
  if (full_) {
    compute_all(full_buffers_, topology, list, state, axis, energies, tubes);
  } else {
    compute_all(mixed_, topology, list, state, axis, energies, tubes);
  }
}

void LineEngine::add_to(int part, const ForceRows& sums) const {
  for (const WrittenRanges::Written& w : written_.on(part))
    in_use([&](const auto& b) { add_range(w.on, b.of_chunks[static_cast<std::size_t>(w.chunk)], sums); });
}

double LineEngine::energy() const {
  return in_use([](const auto& b) {
    double sum = 0;
    for (const auto& out : b.of_chunks) sum += out.energy;
    return sum;
  });
}

// Without the law's exp and log: the same digits in a frame.
PairEnergy LineEngine::pair_energy(const ContactLaw& law) const {
  const auto& line = static_cast<const LineLaw&>(law);
  std::vector<FullTable> tables;
  for (const LineContact& pair : line.pairs) tables.emplace_back(pair.density, 1);
  return [&line, tables](TypePair types, const Vector3& separation, const Vector3& n_i, const Vector3& n_j) {
    const LineContact& pair = line.of(types);
    const FullTable& table = tables[static_cast<std::size_t>(&pair - line.pairs.data())];
    return pair.energy_by([&](double distance2) { return table.energy(distance2); }, separation, n_i, n_j);
  };
}

double LineEngine::step_bytes(const NeighbourList&, std::size_t number) const {
  const auto of = [](const auto& v) { return static_cast<double>(v.size() * sizeof(v[0])); };
  double sum = static_cast<double>(list_.spans() * sizeof(NeighbourSpan));
  for (const LineChunk& chunk : list_.chunks()) sum += of(chunk.ranges) + buffer_bytes(chunk.elements, number);
  return sum;
}

std::size_t LineEngine::bytes() const {
  std::size_t total = list_.bytes() + written_.bytes();
  const auto count = [&](const auto& b) {
    for (const auto& out : b.of_chunks) total += out.bytes();
    for (const auto& nodes : b.nodes) total += 3 * nodes.x.capacity() * sizeof(nodes.x[0]);
    for (const auto& work : b.work)
      total += 3 * work.forces.x.capacity() * sizeof(work.forces.x[0]) + work.found.bytes();
  };
  count(mixed_);
  count(full_buffers_);
  return total;
}

}  // namespace ropewalk
