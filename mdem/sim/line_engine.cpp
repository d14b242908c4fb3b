#include "sim/line_engine.hpp"

#include <omp.h>

#include <algorithm>

namespace ropewalk {
namespace {

template <class Buffers>
void make_tables(Buffers& b, const Interaction& in, double unit) {
  if (b.tables_unit == unit && b.tables.size() == in.line.size()) return;
  b.tables.clear();
  for (const LineContact& pair : in.line) b.tables.emplace_back(pair.density, unit);
  b.tables_unit = unit;
}

template <class C>
void place_row(const NodeLayout& layout, const Topology& topology, double length, int tube, const State& state,
               const Vec3Array& axis, LineNodes<C>& nodes) {
  const int count = layout.per_element[static_cast<std::size_t>(topology.tube_type[tube])];
  auto at = static_cast<std::size_t>(layout.begin[static_cast<std::size_t>(tube)]);
  const double unit = nodes.per_unit;
  constexpr int most = 64;
  double s[most];
  for (int l = 0; l < std::min(count, most); ++l) s[l] = line_node(l, count, length) * unit;
  const auto fill = [&](const std::vector<double>& x, const std::vector<double>& n, std::vector<C>& out) {
    C* to = out.data() + at;
    for (int i = topology.tube_begin[tube]; i < topology.tube_begin[tube + 1]; ++i, to += count) {
      const double centre = x[static_cast<std::size_t>(i)] * unit, along = n[static_cast<std::size_t>(i)];
      for (int l = 0; l < count; ++l) {
        const double v = centre + (l < most ? s[l] : line_node(l, count, length) * unit) * along;
        to[l] = sizeof(C) == 4 ? static_cast<C>(std::lrint(v)) : static_cast<C>(v);
      }
    }
  };
  fill(state.position.x, axis.x, nodes.x);
  fill(state.position.y, axis.y, nodes.y);
  fill(state.position.z, axis.z, nodes.z);
}

}  // namespace

void LineEngine::describe(const Topology& topology, const Interaction& in, const NeighbourList& list) {
  list_.build(topology, in, list);
  stamp_ = list.stamp();
  full_ = in.precision == Interaction::Precision::full;
  const auto n = static_cast<std::size_t>(topology.elements());
  type_.resize(n);
  length_.clear();
  for (std::size_t a = 0; a < topology.types.size(); ++a)
    length_.push_back(in.line[a * topology.types.size()].length_i);
  for (int t = 0; t < topology.tubes(); ++t)
    std::fill(type_.begin() + topology.tube_begin[t], type_.begin() + topology.tube_begin[t + 1],
              topology.tube_type[t]);
  const auto prepare = [&](auto& b, double unit) {
    make_tables(b, in, unit);
    b.nodes.per_unit = 1 / unit;
    for (auto* v : {&b.nodes.x, &b.nodes.y, &b.nodes.z})
      v->resize(static_cast<std::size_t>(list_.layout().total()));
  };
  if (full_) {
    prepare(full_buffers_, 1);
  } else {
    prepare(mixed_, list_.unit());
  }
}

template <class Buffers>
void LineEngine::run(Buffers& b, const Topology& topology, const Interaction& in, const NeighbourList& list,
                     const State& state, const Vec3Array& axis, ContactBuffer* buffers) {
  const NodeLayout& layout = list_.layout();
#pragma omp parallel for schedule(static) if (state.size() > parallel_from)
  for (int t = 0; t < topology.tubes(); ++t)
    place_row(layout, topology, length_[static_cast<std::size_t>(topology.tube_type[t])], t, state, axis, b.nodes);
  const LineKernelInput<typename Buffers::Table, typename Buffers::C> input{
      &topology, &in, &state, &axis, &list_, &b.nodes, b.tables.data(), type_.data(), 2 * list.displacement()};
  b.forces.resize(list.chunks().size());
  b.scratch.resize(list.chunks().size());
#pragma omp parallel for schedule(static) if (state.size() > parallel_from)
  for (std::size_t k = 0; k < list.chunks().size(); ++k) {
    const NeighbourList::Chunk& chunk = list.chunks()[k];
    buffers[k].clear(static_cast<std::size_t>(chunk.touched_end - chunk.touched_begin));
    if (chunk.begin == chunk.end) {
      b.forces[k].clear(0, 0);
      continue;
    }
    const int first_tube = topology.tube_of(chunk.touched_begin),
              last_tube = topology.tube_of(chunk.touched_end - 1);
    b.forces[k].clear(layout.first(topology, first_tube, chunk.touched_begin),
                      layout.first(topology, last_tube, chunk.touched_end));
    line_contact(input, chunk, b.scratch[k], b.forces[k], buffers[k]);
    if (in.damped_contact()) line_damping(in, state, list_, chunk, buffers[k]);
  }
}

void LineEngine::compute(const Topology& topology, const Interaction& in, const NeighbourList& list,
                         const State& state, const Vec3Array& axis, ContactBuffer* buffers) {
  if (stamp_ != list.stamp()) {
    const double began = omp_get_wtime();
    describe(topology, in, list);
    list_seconds_ += omp_get_wtime() - began;
  }
  if (full_) {
    run(full_buffers_, topology, in, list, state, axis, buffers);
  } else {
    run(mixed_, topology, in, list, state, axis, buffers);
  }
}

template <class Buffers>
void LineEngine::add(const Buffers& b, const Topology& topology, const NeighbourList& list, const Vec3Array& axis,
                     int tube, Vec3Array& force, Vec3Array& torque) const {
  using T = typename Buffers::T;
  const NodeLayout& layout = list_.layout();
  const std::size_t type = static_cast<std::size_t>(topology.tube_type[tube]);
  const int count = layout.per_element[type];
  const int begin = topology.tube_begin[tube], end = topology.tube_begin[tube + 1];
  const int first = layout.begin[static_cast<std::size_t>(tube)], nodes = (end - begin) * count;
  thread_local std::vector<T> sum[3];
  for (auto& v : sum) v.assign(static_cast<std::size_t>(nodes), T{0});
  for (std::size_t k = 0; k < list.chunks().size(); ++k) {
    const NodeForces<T>& f = b.forces[k];
    const NeighbourList::Chunk& chunk = list.chunks()[k];
    const int low = std::max(begin, chunk.touched_begin), high = std::min(end, chunk.touched_end);
    if (low >= high) continue;
    const int from = (low - begin) * count, to = (high - begin) * count, shift = first - f.first;
    const auto add_up = [&](const std::vector<T>& x, std::vector<T>& out) {
      const T* source = x.data() + shift;
      for (int m = from; m < to; ++m) out[static_cast<std::size_t>(m)] += source[m];
    };
    add_up(f.x, sum[0]);
    add_up(f.y, sum[1]);
    add_up(f.z, sum[2]);
  }
  const double step = length_[type] / count, middle = 0.5 * (count - 1);
  const T *x = sum[0].data(), *y = sum[1].data(), *z = sum[2].data();
  for (int i = begin; i < end; ++i, x += count, y += count, z += count) {
    double f[3] = {0, 0, 0}, m[3] = {0, 0, 0};
    for (int l = 0; l < count; ++l) {
      const double s = l - middle, v[3] = {x[l], y[l], z[l]};
      for (int a = 0; a < 3; ++a) {
        f[a] += v[a];
        m[a] += s * v[a];
      }
    }
    const auto at = static_cast<std::size_t>(i);
    force.x[at] += f[0];
    force.y[at] += f[1];
    force.z[at] += f[2];
    const double nx = step * axis.x[at], ny = step * axis.y[at], nz = step * axis.z[at];
    torque.x[at] += ny * m[2] - nz * m[1];
    torque.y[at] += nz * m[0] - nx * m[2];
    torque.z[at] += nx * m[1] - ny * m[0];
  }
}

void LineEngine::add_node_forces(const Topology& topology, const NeighbourList& list, const Vec3Array& axis,
                                 int tube, Vec3Array& force, Vec3Array& torque) const {
  if (full_) {
    add(full_buffers_, topology, list, axis, tube, force, torque);
  } else {
    add(mixed_, topology, list, axis, tube, force, torque);
  }
}

std::size_t LineEngine::bytes() const {
  std::size_t total = list_.bytes() + type_.capacity() * sizeof(int);
  const auto count = [&](const auto& b) {
    total += 3 * b.nodes.x.capacity() * sizeof(b.nodes.x[0]);
    for (const auto& f : b.forces) total += 3 * f.x.capacity() * sizeof(f.x[0]);
  };
  count(mixed_);
  count(full_buffers_);
  return total;
}

}  // namespace ropewalk
