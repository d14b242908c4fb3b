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

template <class C>
void place_row(const NodeLayout& layout, const Topology& topology, double length, int tube, const State& state,
               const Vec3Array& axis, LineNodes<C>& nodes) {
  const int count = layout.per_element[static_cast<std::size_t>(topology.tube_type[tube])];
  const auto at = static_cast<std::size_t>(layout.begin[static_cast<std::size_t>(tube)]);
  const auto first = static_cast<std::size_t>(topology.tube_begin[tube]);
  const double unit = nodes.per_unit;
  thread_local std::vector<double> s;
  s.resize(static_cast<std::size_t>(count));
  for (int l = 0; l < count; ++l) s[static_cast<std::size_t>(l)] = line_node(l, count, length) * unit;
  const auto fill = [&](const std::vector<double>& x, const std::vector<double>& n, std::vector<C>& out) {
    const auto place = count == 3 ? place_nodes<3, C> : count == 6 ? place_nodes<6, C> : place_nodes<0, C>;
    place(x.data() + first, n.data() + first, topology.length_of(tube), count, s.data(), unit, out.data() + at);
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
template <class T>
inline void add_all(const T* from, int n, T* to) {
  for (int i = 0; i < n; ++i) to[i] += from[i];
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
ROPEWALK_VECTOR_CLONES __attribute__((flatten)) void add(const float* from, int n, float* to) {
  add_all(from, n, to);
}
ROPEWALK_VECTOR_CLONES __attribute__((flatten)) void add(const double* from, int n, double* to) {
  add_all(from, n, to);
}

// Force and torque on each of the elements, of which x, y and z are the forces on the nodes.
template <class T>
void add_rows(const T* x, const T* y, const T* z, int begin, int end, int count, double length,
              const Vec3Array& axis, Vec3Array& force, Vec3Array& torque) {
  thread_local std::vector<T> sums;
  const int elements = end - begin;
  sums.resize(static_cast<std::size_t>(6 * elements));
  T *fx = sums.data(), *fy = fx + elements, *fz = fy + elements, *mx = fz + elements, *my = mx + elements,
    *mz = my + elements;
  moments(x, elements, count, fx, mx);
  moments(y, elements, count, fy, my);
  moments(z, elements, count, fz, mz);
  const double step = length / count;
  const double *nx = axis.x.data() + begin, *ny = axis.y.data() + begin, *nz = axis.z.data() + begin;
  add({fx, ny, mz, nz, my}, step, elements, force.x.data() + begin, torque.x.data() + begin);
  add({fy, nz, mx, nx, mz}, step, elements, force.y.data() + begin, torque.y.data() + begin);
  add({fz, nx, my, ny, mx}, step, elements, force.z.data() + begin, torque.z.data() + begin);
}

void add_elements(const ContactBuffer& b, const TouchedTube& t, Vec3Array& force, Vec3Array& torque) {
  const auto onto = [&](const std::vector<double>& from, std::vector<double>& to) {
    add(from.data() + t.element_shift + t.begin, t.end - t.begin, to.data() + t.begin);
  };
  onto(b.fx, force.x), onto(b.fy, force.y), onto(b.fz, force.z);
  onto(b.tx, torque.x), onto(b.ty, torque.y), onto(b.tz, torque.z);
}

}  // namespace

void LineEngine::describe(const Topology& topology, const Interaction& in, const NeighbourList& list) {
  list_.build(topology, in, list);
  stamp_ = list.stamp();
  full_ = in.precision == Interaction::Precision::full;
  length_.clear();
  for (std::size_t a = 0; a < topology.types.size(); ++a)
    length_.push_back(in.line[a * topology.types.size()].length_i);
  const auto prepare = [&](auto& b, double unit) {
    make_tables(b, in, unit);
    b.work.resize(list_.chunks().size());
    for (const Rows kind : {Rows::all, Rows::sparse}) {
      auto& nodes = b.nodes[static_cast<int>(kind)];
      nodes.per_unit = 1 / unit;
      for (auto* v : {&nodes.x, &nodes.y, &nodes.z})
        v->resize(static_cast<std::size_t>(list_.layout(kind).total() + NodeLayout::pad));
    }
  };
  buffers_.resize(list_.chunks().size());
  if (full_) {
    prepare(full_buffers_, 1);
  } else {
    prepare(mixed_, list_.unit());
  }
}

template <class Buffers>
void LineEngine::run(Buffers& b, const Topology& topology, const Interaction& in, const NeighbourList& list,
                     const State& state, const Vec3Array& axis, bool energies, const TubeWork& tubes) {
  LineKernelInput<typename Buffers::Table, typename Buffers::C> input{&topology,
                                                                      &in,
                                                                      &state,
                                                                      &axis,
                                                                      &list_,
                                                                      b.nodes,
                                                                      b.tables.data(),
                                                                      b.pairs.data(),
                                                                      {},
                                                                      list.turn(),
                                                                      2 * list.displacement(),
                                                                      energies};
  for (int t = 0; t < line_sums; ++t) input.rows[t] = in.line[0].sparse.thins_j(t) ? Rows::sparse : Rows::all;
  const bool parallel = state.size() > parallel_from, at_once = state.size() > finish_at_once_from;
  const auto timed = [&](const auto& work) {
    if (omp_get_thread_num() != 0) return work();
    const double began = omp_get_wtime();
    work();
    finish_seconds_ += omp_get_wtime() - began;
  };
  left_.resize(static_cast<std::size_t>(topology.tubes()));
  shares_.deal(static_cast<int>(list_.chunks().size()), parallel ? omp_get_max_threads() : 1);
#pragma omp parallel if (parallel)
  {
#pragma omp for schedule(static)
    for (int t = 0; t < topology.tubes(); ++t) {
      tubes.place(t);
      left_.set(t, static_cast<int>(list_.touches_end(t) - list_.touches_begin(t)));
      for (const Rows kind : {Rows::all, Rows::sparse})
        if (list_.layout(kind).has_row(t))
          place_row(list_.layout(kind), topology, length_[static_cast<std::size_t>(topology.tube_type[t])], t,
                    state, axis, b.nodes[static_cast<int>(kind)]);
    }
    for (int piece; (piece = shares_.take(omp_get_thread_num())) >= 0;) {
      const auto k = static_cast<std::size_t>(piece);
      const LineChunk& chunk = list_.chunks()[k];
      buffers_[k].clear(static_cast<std::size_t>(chunk.elements));
      b.work[k].start(chunk);
      line_contact(input, chunk, b.work[k], buffers_[k]);
      if (in.damped_contact())
        contact_damping(in.damping.contact, state, chunk.damped, chunk.own_shift(), buffers_[k]);
      if (at_once)
        timed([&] {
          for (const TouchedTube& touched : chunk.touched)
            if (left_.last(touched.tube)) tubes.finish(touched.tube);
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

template <class Buffers>
void LineEngine::add_nodes(const Buffers& b, const Topology& topology, const Vec3Array& axis, int tube,
                           Vec3Array& force, Vec3Array& torque) const {
  using T = typename Buffers::T;
  const int begin = topology.tube_begin[tube], end = topology.tube_begin[tube + 1];
  const double length = length_[static_cast<std::size_t>(topology.tube_type[tube])];
  thread_local std::vector<T> sum[3];
  for (int kind = 0; kind < row_kinds; ++kind) {
    bool any = false;
    int count = 0;
    for (const LineList::Touch* touch = list_.touches_begin(tube); touch != list_.touches_end(tube); ++touch) {
      const NodeForces<T>& f = b.work[static_cast<std::size_t>(touch->chunk)].forces[kind];
      if (!f.used[static_cast<std::size_t>(touch->index)]) continue;
      const TouchedTube& t =
          list_.chunks()[static_cast<std::size_t>(touch->chunk)].touched[static_cast<std::size_t>(touch->index)];
      const TouchedTube::Row& row = t.row[kind];
      count = row.per_element;
      const std::size_t nodes = static_cast<std::size_t>((end - begin) * count);
      if (!any)
        for (auto& v : sum) set_zero(v, nodes);
      any = true;
      const int from = (t.begin - begin) * count, to = (t.end - begin) * count;
      const int shift = row.origin + begin * count + row.shift;
      const auto add_up = [&](const std::vector<T>& x, std::vector<T>& out) {
        add(x.data() + shift + from, to - from, out.data() + from);
      };
      add_up(f.x, sum[0]);
      add_up(f.y, sum[1]);
      add_up(f.z, sum[2]);
    }
    if (any) add_rows(sum[0].data(), sum[1].data(), sum[2].data(), begin, end, count, length, axis, force, torque);
  }
}

void LineEngine::add_to_tube(const Topology& topology, const Vec3Array& axis, int tube, Vec3Array& force,
                             Vec3Array& torque) const {
  for (const LineList::Touch* touch = list_.touches_begin(tube); touch != list_.touches_end(tube); ++touch) {
    const auto chunk = static_cast<std::size_t>(touch->chunk);
    add_elements(buffers_[chunk], list_.chunks()[chunk].touched[static_cast<std::size_t>(touch->index)], force,
                 torque);
  }
  if (full_) {
    add_nodes(full_buffers_, topology, axis, tube, force, torque);
  } else {
    add_nodes(mixed_, topology, axis, tube, force, torque);
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
    for (const auto& nodes : b.nodes) total += 3 * nodes.x.capacity() * sizeof(nodes.x[0]);
    for (const auto& work : b.work)
      for (const auto& f : work.forces) total += 3 * f.x.capacity() * sizeof(f.x[0]);
  };
  count(mixed_);
  count(full_buffers_);
  return total;
}

}  // namespace ropewalk
