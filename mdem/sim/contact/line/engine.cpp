#include "sim/contact/line/engine.hpp"

#include <omp.h>

#include "sim/threads/vector_clones.hpp"

namespace ropewalk {
namespace {

template <class Buffers>
void make_tables(Buffers& b, const Interaction& in, double unit) {
  if (b.tables_unit == unit && b.tables.size() == in.line.size()) return;
  b.tables.clear();
  b.pairs.clear();
  for (const LineContact& pair : in.line) {
    b.tables.emplace_back(pair.density, unit);
    b.pairs.emplace_back(pair);
  }
  b.tables_unit = unit;
}

// What a buffer holds for elements of a tube, element j at j + shift.
template <class T>
__attribute__((always_inline)) inline void add_all(const TouchedRange& of, const ContactBuffer<T>& b,
                                                   const ForceRows& sums) {
  const std::vector<T>* const from[6] = {&b.fx, &b.fy, &b.fz, &b.tx, &b.ty, &b.tz};
  Vec3Array &force = sums.force, &torque = sums.torque;
  std::vector<double>* const to[6] = {&force.x, &force.y, &force.z, &torque.x, &torque.y, &torque.z};
  for (int a = 0; a < 6; ++a) {
    const T* const on = from[a]->data() + of.begin + of.shift;
    double* const sum = to[a]->data() + of.begin - sums.origin;
#pragma omp simd
    for (int i = 0; i < of.end - of.begin; ++i) sum[i] += static_cast<double>(on[i]);
  }
}
ROPEWALK_VECTOR_CLONES void add_range(const TouchedRange& of, const ContactBuffer<float>& b,
                                      const ForceRows& sums) {
  add_all(of, b, sums);
}
ROPEWALK_VECTOR_CLONES void add_range(const TouchedRange& of, const ContactBuffer<double>& b,
                                      const ForceRows& sums) {
  add_all(of, b, sums);
}

void add_viscosity(const ContactViscosity& viscosity, const State& state, const LineChunk& chunk, double /*unit*/,
                   LineWork<double>& /*work*/, ContactBuffer<double>& out) {
  contact_damping(viscosity, state, chunk.damped, out);
}
void add_viscosity(const ContactViscosity& viscosity, const State& state, const LineChunk& chunk, double unit,
                   LineWork<float>& work, ContactBuffer<float>& out) {
  contact_damping(viscosity, state, {chunk.damped, chunk.damped_parts, unit}, work.damped, out);
}

}  // namespace

void LineEngine::describe(const Topology& topology, const Interaction& in, const NeighbourList& list,
                          const TubeParts& parts) {
  list_.build(topology, in, list);
  stamp_ = list.stamp();
  full_ = in.precision == Interaction::Precision::full;
  for (const Rows kind : {Rows::all, Rows::sparse}) {
    auto& places = places_[static_cast<int>(kind)];
    places.clear();
    for (std::size_t a = 0; a < topology.types.size(); ++a)
      places.push_back(
          node_places(list_.per_element(kind, static_cast<int>(a)), in.line[a * topology.types.size()].length_i));
  }
  touches_.list(parts, list_.chunks());
  if (full_) {
    make_tables(full_buffers_, in, 1);
  } else {
    make_tables(mixed_, in, list_.unit());
  }
}

template <class Buffers>
void LineEngine::make_room(Buffers& b, std::size_t threads) const {
  b.of_chunks.resize(list_.chunks().size());
  b.nodes.resize(threads);
  b.work.resize(threads);
  for (auto& rows : b.nodes)
    for (const Rows kind : {Rows::all, Rows::sparse}) {
      auto& nodes = rows[static_cast<std::size_t>(kind)];
      nodes.per_unit = 1 / b.tables_unit;
      nodes.make_room(list_.most_nodes(kind));
    }
  for (auto& work : b.work) work.make_room(list_);
}

// The contact of one chunk, by one thread: its rows of nodes, what acts on them, and that on their elements.
template <class Buffers>
void LineEngine::meet(std::size_t k, std::size_t thread, Buffers& b, KernelInput<Buffers> in) {
  const LineChunk& chunk = list_.chunks()[k];
  LineNodes<typename Buffers::C>* const nodes = b.nodes[thread].data();
  auto& work = b.work[thread];
  auto& out = b.of_chunks[k];
  const RowsOf rows{chunk, in.topology->tube_type, places_, in.state->position, *in.axis, in.moved};
  place_nodes(rows, nodes);
  in.nodes = nodes;
  out.clear(static_cast<std::size_t>(chunk.elements));
  if (in.interaction->damped_contact())
    add_viscosity(in.interaction->damping.contact, *in.state, chunk, list_.unit(), work, out);
  work.start(chunk, plan_.chunk(k));
  line_contact(in, chunk, work, out);
  add_node_forces(rows, work.forces, out);
}

template <class Buffers>
void LineEngine::run(Buffers& b, const Topology& topology, const Interaction& in, const NeighbourList& list,
                     const State& state, const Vec3Array& axis, bool energies, const TubeWork& tubes) {
  KernelInput<Buffers> input{
      &topology,           &in,     &state, &axis, &list_, nullptr, b.tables.data(), b.pairs.data(), {}, 0, 0,
      LinePlan::Use::none, energies};
  for (int t = 0; t < line_sums; ++t) input.rows[t] = in.line[0].sparse.thins_j(t) ? Rows::sparse : Rows::all;
  const bool parallel = state.size() > parallel_from, at_once = state.size() > finish_at_once_from;
  const int threads = parallel ? omp_get_max_threads() : 1;
  make_room(b, static_cast<std::size_t>(threads));
  left_.start(touches_.chunks_on());
  const auto finish = [&](int block) {
    if (omp_get_thread_num() != 0) return tubes.finish(block);
    const double began = omp_get_wtime();
    tubes.finish(block);
    finish_seconds_ += omp_get_wtime() - began;
  };
  shares_.deal(static_cast<int>(list_.chunks().size()), threads);
  plan_.start(topology, list, list_);
  const auto choose = [&] {
    plan_.choose(state, axis);
    input.turned = plan_.turned();
    input.moved = moved_ = plan_.moved();
    input.plan = plan_.use();
  };
  if (!plan_.wanted()) choose();
#pragma omp parallel num_threads(threads) if (parallel)
  {
#pragma omp for schedule(static)
    for (int t = 0; t < topology.tubes(); ++t) {
      tubes.place(t);
      plan_.look(topology, state, t);
    }
    if (plan_.wanted()) {
#pragma omp single
      choose();
    }
    const int thread = omp_get_thread_num();
    for (int piece; (piece = shares_.take(thread)) >= 0;) {
      const auto k = static_cast<std::size_t>(piece);
      meet(k, static_cast<std::size_t>(thread), b, input);
      if (at_once)
        for (int block : touches_.blocks(k))
          if (left_.last(block)) finish(block);
    }
#pragma omp barrier
#pragma omp for schedule(static)
    for (int block = 0; block < tubes.parts.blocks(); ++block)
      if (!at_once || touches_.chunks_on()[static_cast<std::size_t>(block)] == 0) finish(block);
  }
}

void LineEngine::compute(const Topology& topology, const Interaction& in, const NeighbourList& list,
                         const State& state, const Vec3Array& axis, bool energies, const TubeWork& tubes) {
  if (stamp_ != list.stamp()) {
    const double began = omp_get_wtime();
    describe(topology, in, list, tubes.parts);
    list_seconds_ += omp_get_wtime() - began;
  }
  if (full_) {
    run(full_buffers_, topology, in, list, state, axis, energies, tubes);
  } else {
    run(mixed_, topology, in, list, state, axis, energies, tubes);
  }
}

void LineEngine::resume(const Topology& topology, const Interaction& in, const NeighbourList& list,
                        LinePlan::Saved plan) {
  State made(plan.position.size());
  made.position = plan.position;
  const Vec3Array axis = plan.axis;
  plan_.resume(list, std::move(plan));
  const TubeParts parts(topology);
  const auto nothing = [](int) {};
  compute(topology, in, list, made, axis, false, {parts, nothing, nothing});
}

void LineEngine::add_to(int part, const ForceRows& sums) const {
  for (const LineTouches::Touch& touch : touches_.on(part))
    if (may_be_in_reach(touch.beyond, moved_))
      in_use([&](const auto& b) { add_range(touch.on, b.of_chunks[static_cast<std::size_t>(touch.chunk)], sums); });
}

double LineEngine::energy() const {
  return in_use([](const auto& b) {
    double sum = 0;
    for (const auto& out : b.of_chunks) sum += out.energy;
    return sum;
  });
}

double LineEngine::damping_power() const {
  return in_use([](const auto& b) {
    double sum = 0;
    for (const auto& out : b.of_chunks) sum += out.power;
    return sum;
  });
}

std::size_t LineEngine::bytes() const {
  std::size_t total = list_.bytes() + touches_.bytes() + plan_.bytes();
  const auto count = [&](const auto& b) {
    for (const auto& out : b.of_chunks) total += out.bytes();
    for (const auto& rows : b.nodes)
      for (const auto& nodes : rows) total += 3 * nodes.x.capacity() * sizeof(nodes.x[0]);
    for (const auto& work : b.work) {
      for (const auto& f : work.forces) total += 3 * f.x.capacity() * sizeof(f.x[0]);
      total += work.damped.bytes();
    }
  };
  count(mixed_);
  count(full_buffers_);
  return total;
}

}  // namespace ropewalk
