#include "sim/line_engine.hpp"

#include <omp.h>

#include <algorithm>

#include "sim/vector_clones.hpp"

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

template <class C>
C rounded(double v) {
  return sizeof(C) == 4 ? static_cast<C>(std::lrint(v)) : static_cast<C>(v);
}

// One coordinate of a row: `elements` centres and axes in, `count` nodes for each out. A count known to the
// compiler keeps the loop over it out of the way.
template <int known, class C>
void place_nodes(const double* x, const double* n, int elements, int count, const double* s, double unit, C* to) {
  const int nodes = known > 0 ? known : count;
  for (int i = 0; i < elements; ++i, to += nodes) {
    const double centre = x[i] * unit, along = n[i];
    for (int l = 0; l < nodes; ++l) to[l] = rounded<C>(centre + s[l] * along);
  }
}

// The nodes of the elements begin .. end of a tube, `count` of each, from node `at` on.
template <class C>
void place_elements(int begin, int end, int count, double length, const State& state, const Vec3Array& axis, int at,
                    LineNodes<C>& nodes) {
  const double unit = nodes.per_unit;
  thread_local std::vector<double> s;
  s.resize(static_cast<std::size_t>(count));
  for (int l = 0; l < count; ++l) s[static_cast<std::size_t>(l)] = line_node(l, count, length) * unit;
  const auto fill = [&](const std::vector<double>& x, const std::vector<double>& n, std::vector<C>& out) {
    const auto place = count == 3 ? place_nodes<3, C> : count == 6 ? place_nodes<6, C> : place_nodes<0, C>;
    place(x.data() + begin, n.data() + begin, end - begin, count, s.data(), unit, out.data() + at);
  };
  fill(state.position.x, axis.x, nodes.x);
  fill(state.position.y, axis.y, nodes.y);
  fill(state.position.z, axis.z, nodes.z);
}

// The sum of each element's nodes and its first moment, in nodes, from the middle. `known` as above.
template <int known, class T>
inline void moments_of(const T* x, int elements, int count, T* sum, T* moment) {
  const int nodes = known > 0 ? known : count;
  const T middle = static_cast<T>(0.5) * static_cast<T>(nodes - 1);
  for (int i = 0; i < elements; ++i, x += nodes) {
    T f = 0, m = 0;
    for (int l = 0; l < nodes; ++l) {
      f += x[l];
      m += (static_cast<T>(l) - middle) * x[l];
    }
    sum[i] = f;
    moment[i] = m;
  }
}

template <class T>
inline void moments_of(const T* x, int elements, int count, T* sum, T* moment) {
  if (count == 3) return moments_of<3>(x, elements, count, sum, moment);
  if (count == 6) return moments_of<6>(x, elements, count, sum, moment);
  moments_of<0>(x, elements, count, sum, moment);
}

// One component of the force f and of the torque step (n1 m2 - n2 m1) of each element.
template <class T>
struct Component {
  const T* f;
  const double* n1;
  const T* m2;
  const double* n2;
  const T* m1;
};
template <class T>
inline void add_component(const Component<T>& c, double step, int elements, double* force, double* torque) {
  for (int i = 0; i < elements; ++i) {
    force[i] += static_cast<double>(c.f[i]);
    torque[i] += step * (c.n1[i] * static_cast<double>(c.m2[i]) - c.n2[i] * static_cast<double>(c.m1[i]));
  }
}
// The same for each vector unit; templates cannot be.
ROPEWALK_VECTOR_CLONES __attribute__((flatten)) void moments(const float* x, int elements, int count, float* sum,
                                                             float* moment) {
  moments_of(x, elements, count, sum, moment);
}
ROPEWALK_VECTOR_CLONES __attribute__((flatten)) void moments(const double* x, int elements, int count, double* sum,
                                                             double* moment) {
  moments_of(x, elements, count, sum, moment);
}
ROPEWALK_VECTOR_CLONES __attribute__((flatten)) void add(const Component<float>& c, double step, int elements,
                                                         double* force, double* torque) {
  add_component(c, step, elements, force, torque);
}
ROPEWALK_VECTOR_CLONES __attribute__((flatten)) void add(const Component<double>& c, double step, int elements,
                                                         double* force, double* torque) {
  add_component(c, step, elements, force, torque);
}
ROPEWALK_VECTOR_CLONES void add(const double* from, int n, double* to) {
  for (int i = 0; i < n; ++i) to[i] += from[i];
}

// Adds force and torque on the elements from `begin` on, of which x, y and z are the forces on the nodes, to the
// entries from `at` on.
template <class T>
void add_rows(const T* x, const T* y, const T* z, int begin, int elements, int count, double length,
              const Vec3Array& axis, ContactBuffer& to, int at) {
  thread_local std::vector<T> sums;
  sums.resize(static_cast<std::size_t>(6 * elements));
  T *fx = sums.data(), *fy = fx + elements, *fz = fy + elements, *mx = fz + elements, *my = mx + elements,
    *mz = my + elements;
  moments(x, elements, count, fx, mx);
  moments(y, elements, count, fy, my);
  moments(z, elements, count, fz, mz);
  const double step = length / count;
  const double *nx = axis.x.data() + begin, *ny = axis.y.data() + begin, *nz = axis.z.data() + begin;
  add({fx, ny, mz, nz, my}, step, elements, to.fx.data() + at, to.tx.data() + at);
  add({fy, nz, mx, nx, mz}, step, elements, to.fy.data() + at, to.ty.data() + at);
  add({fz, nx, my, ny, mx}, step, elements, to.fz.data() + at, to.tz.data() + at);
}

}  // namespace

void LineEngine::describe(const Topology& topology, const Interaction& in, const NeighbourList& list) {
  list_.build(topology, in, list);
  stamp_ = list.stamp();
  full_ = in.precision == Interaction::Precision::full;
  length_.clear();
  for (std::size_t a = 0; a < topology.types.size(); ++a)
    length_.push_back(in.line[a * topology.types.size()].length_i);
  buffers_.resize(list_.chunks().size());
  if (full_) {
    make_tables(full_buffers_, in, 1);
  } else {
    make_tables(mixed_, in, list_.unit());
  }
}

template <class Buffers>
void LineEngine::make_room(Buffers& b, std::size_t threads) const {
  b.nodes.resize(threads);
  b.work.resize(threads);
  for (std::size_t kind = 0; kind < row_kinds; ++kind) {
    int most = 0;
    for (const LineChunk& chunk : list_.chunks()) most = std::max(most, chunk.nodes[kind]);
    for (auto& rows : b.nodes) {
      rows[kind].per_unit = 1 / b.tables_unit;
      for (auto* v : {&rows[kind].x, &rows[kind].y, &rows[kind].z})
        v->resize(static_cast<std::size_t>(most + NodeRow::pad));
    }
  }
}

double LineEngine::length_of(const Topology& topology, int tube) const {
  return length_[static_cast<std::size_t>(topology.tube_type[tube])];
}

// The contact of one chunk, by one thread: its rows of nodes, what acts on them, and that on their elements.
template <class Buffers>
void LineEngine::meet(std::size_t k, std::size_t thread, Buffers& b, KernelInput<Buffers> in) {
  const LineChunk& chunk = list_.chunks()[k];
  auto& rows = b.nodes[thread];
  auto& work = b.work[thread];
  ContactBuffer& out = buffers_[k];
  const auto of_each_row = [&](const auto& what) {
    for (std::size_t p = 0; p < chunk.parts.size(); ++p)
      for (std::size_t kind = 0; kind < row_kinds; ++kind)
        if (chunk.parts[p].row[kind].per_element > 0) what(p, kind, length_of(*in.topology, chunk.parts[p].tube));
  };
  of_each_row([&](std::size_t p, std::size_t kind, double length) {
    const TouchedPart& part = chunk.parts[p];
    const TouchedPart::Row& row = part.row[kind];
    place_elements(part.begin, part.end, row.per_element, length, *in.state, *in.axis, row.first(part.begin),
                   rows[kind]);
  });
  in.nodes = rows.data();
  out.clear(static_cast<std::size_t>(chunk.elements));
  work.start(chunk);
  line_contact(in, chunk, work, out);
  of_each_row([&](std::size_t p, std::size_t kind, double length) {
    const auto& f = work.forces[kind];
    if (!f.used[p]) return;
    const TouchedPart& part = chunk.parts[p];
    const int count = part.row[kind].per_element, at = part.row[kind].first(part.begin);
    add_rows(f.x.data() + at, f.y.data() + at, f.z.data() + at, part.begin, part.end - part.begin, count, length,
             *in.axis, out, part.begin + part.element_shift);
  });
  if (in.interaction->damped_contact())
    contact_damping(in.interaction->damping.contact, *in.state, chunk.damped, out);
}

template <class Buffers>
void LineEngine::run(Buffers& b, const Topology& topology, const Interaction& in, const NeighbourList& list,
                     const State& state, const Vec3Array& axis, bool energies, const TubeWork& tubes) {
  KernelInput<Buffers> input{&topology,
                             &in,
                             &state,
                             &axis,
                             &list_,
                             nullptr,
                             b.tables.data(),
                             b.pairs.data(),
                             {},
                             list.turn(),
                             2 * list.displacement(),
                             energies};
  for (int t = 0; t < line_sums; ++t) input.rows[t] = in.line[0].sparse.thins_j(t) ? Rows::sparse : Rows::all;
  const bool parallel = state.size() > parallel_from,
             at_once = state.size() > finish_at_once_from && list_.parts_of_a_tube() < few_parts;
  const int threads = parallel ? omp_get_max_threads() : 1;
  const auto timed = [&](const auto& work) {
    if (omp_get_thread_num() != 0) return work();
    const double began = omp_get_wtime();
    work();
    finish_seconds_ += omp_get_wtime() - began;
  };
  make_room(b, static_cast<std::size_t>(threads));
  left_.resize(static_cast<std::size_t>(topology.tubes()));
  shares_.deal(static_cast<int>(list_.chunks().size()), threads);
#pragma omp parallel num_threads(threads) if (parallel)
  {
#pragma omp for schedule(static)
    for (int t = 0; t < topology.tubes(); ++t) {
      tubes.place(t);
      const int parts = static_cast<int>(list_.touches_end(t) - list_.touches_begin(t));
      left_.set(t, parts);
      if (at_once && parts == 0) timed([&] { tubes.finish(t); });
    }
    const int thread = omp_get_thread_num();
    for (int piece; (piece = shares_.take(thread)) >= 0;) {
      const auto k = static_cast<std::size_t>(piece);
      meet(k, static_cast<std::size_t>(thread), b, input);
      if (at_once)
        timed([&] {
          for (const TouchedPart& part : list_.chunks()[k].parts)
            if (left_.last(part.tube)) tubes.finish(part.tube);
        });
    }
    if (!at_once) {
#pragma omp barrier
      timed([&] {
#pragma omp for schedule(static)
        for (int t = 0; t < topology.tubes(); ++t) tubes.finish(t);
      });
    }
  }
}

void LineEngine::compute(const Topology& topology, const Interaction& in, const NeighbourList& list,
                         const State& state, const Vec3Array& axis, bool energies, const TubeWork& tubes) {
  if (stamp_ != list.stamp()) {
    const double began = omp_get_wtime();
    describe(topology, in, list);
    list_seconds_ += omp_get_wtime() - began;
  }
  if (full_) {
    run(full_buffers_, topology, in, list, state, axis, energies, tubes);
  } else {
    run(mixed_, topology, in, list, state, axis, energies, tubes);
  }
}

void LineEngine::add_to_tube(int tube, Vec3Array& force, Vec3Array& torque) const {
  for (const LineList::Touch* touch = list_.touches_begin(tube); touch != list_.touches_end(tube); ++touch) {
    const TouchedPart& part = list_.part(*touch);
    const ContactBuffer& b = buffers_[static_cast<std::size_t>(touch->chunk)];
    const auto onto = [&](const std::vector<double>& from, std::vector<double>& to) {
      add(from.data() + part.element_shift + part.begin, part.end - part.begin, to.data() + part.begin);
    };
    onto(b.fx, force.x), onto(b.fy, force.y), onto(b.fz, force.z);
    onto(b.tx, torque.x), onto(b.ty, torque.y), onto(b.tz, torque.z);
  }
}

double LineEngine::energy() const {
  double sum = 0;
  for (const ContactBuffer& b : buffers_) sum += b.energy;
  return sum;
}

double LineEngine::damping_power() const {
  double sum = 0;
  for (const ContactBuffer& b : buffers_) sum += b.power;
  return sum;
}

std::size_t LineEngine::bytes() const {
  std::size_t total = list_.bytes();
  for (const ContactBuffer& b : buffers_) total += 6 * b.fx.capacity() * sizeof(double);
  const auto count = [&](const auto& b) {
    for (const auto& rows : b.nodes)
      for (const auto& nodes : rows) total += 3 * nodes.x.capacity() * sizeof(nodes.x[0]);
    for (const auto& work : b.work)
      for (const auto& f : work.forces) total += 3 * f.x.capacity() * sizeof(f.x[0]);
  };
  count(mixed_);
  count(full_buffers_);
  return total;
}

}  // namespace ropewalk
