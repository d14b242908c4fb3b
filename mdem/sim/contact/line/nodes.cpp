#include "sim/contact/line/nodes.hpp"

#include <algorithm>

#include "sim/contact/shared/wrapped.hpp"

#undef VEC_SOURCE
#define VEC_SOURCE "sim/contact/line/nodes.cpp"
#include "sim/vectors/each_set-inl.hpp"
//
#include "sim/vectors/operations-inl.hpp"

VEC_BEFORE_NAMESPACE();
namespace ropewalk::VEC_SET {
namespace nodes {
namespace ops = vec::VEC_SET;

constexpr int block = 32;  // elements whose positions or sums stay in the first cache

template <class C>
constexpr double rounds = sizeof(C) == 4 ? rounds_to_whole : 0.0;

template <class D>
VEC_INLINE void store(D, ops::Vec<D> v, std::int32_t* to) {
  const ops::RebindToUnsigned<D> bits;
  const ops::Rebind<std::uint32_t, D> low;
  const ops::Rebind<std::int32_t, D> coordinate;
  const auto number = ops::ConvertTo(low, ops::ShiftRight<bits_behind_point>(ops::BitCast(bits, v)));
  ops::Store(ops::BitCast(coordinate, number), coordinate, to);
}
template <class D>
VEC_INLINE void store(D d, ops::Vec<D> v, double* to) {
  ops::Store(v, d, to);
}

// One component of the centres and of the axes of consecutive elements, in units of the nodes.
struct Component {
  double centre[block], along[block];

  template <class C>
  VEC_INLINE void load(const double* x, const double* n, double per_unit, int elements) {
    for (int i = 0; i < elements; ++i) {
      centre[i] = x[i] * per_unit + rounds<C>;
      along[i] = n[i] * per_unit;
    }
  }
};

// The nodes of an element fill some vectors, but for lanes at the end of the last one: the next element's nodes are
// stored over these. A count known to the compiler keeps the places in registers.
template <int known, class D, class C>
VEC_INLINE void position_row(D d, const Component (&of)[3], int elements, int each, const double* s,
                             C* const (&to)[3]) {
  constexpr int lanes = static_cast<int>(ops::Lanes(D()));
  const int vectors = known > 0 ? known : (each + lanes - 1) / lanes;
  for (int i = 0, at = 0; i < elements; ++i, at += each)
    for (int c = 0; c < 3; ++c) {
      const auto centre = ops::Set(d, of[c].centre[i]), along = ops::Set(d, of[c].along[i]);
      for (int v = 0; v < vectors; ++v)
        store(d, ops::MulAdd(ops::Load(d, s + v * lanes), along, centre), to[c] + at + v * lanes);
    }
}

template <class C>
VEC_INLINE void position_row(const Component (&of)[3], int elements, int each, const double* s, C* const (&to)[3]) {
  const ops::CappedTag<double, 4> narrow;
  const ops::CappedTag<double, NodeOffsets::padding> wide;
  if (each <= static_cast<int>(ops::Lanes(narrow))) return position_row<1>(narrow, of, elements, each, s, to);
  if (each <= static_cast<int>(ops::Lanes(wide))) return position_row<1>(wide, of, elements, each, s, to);
  if (each <= 2 * static_cast<int>(ops::Lanes(wide))) return position_row<2>(wide, of, elements, each, s, to);
  position_row<0>(wide, of, elements, each, s, to);
}

template <class What>
VEC_INLINE void for_ranges(const NodeInput& of, const What& what) {
  for (const WrittenRange& range : of.chunk.ranges)
    what(range, of.offsets[static_cast<std::size_t>(of.tube_type[static_cast<std::size_t>(range.tube)])]);
}

template <class C>
VEC_INLINE void position(const NodeInput& of, double per_unit, NodePositions<C>& out) {
  Component component[3];
  const double *x[] = {of.position.x.data(), of.position.y.data(), of.position.z.data()},
               *n[] = {of.axis.x.data(), of.axis.y.data(), of.axis.z.data()};
  for_ranges(of, [&](const WrittenRange& range, const NodeOffsets& offsets) VEC_ATTR {
    for (int from = range.begin; from < range.end; from += block) {
      const int elements = std::min(block, range.end - from), first = range.first_node(from);
      for (int c = 0; c < 3; ++c) component[c].load<C>(x[c] + from, n[c] + from, per_unit, elements);
      position_row<C>(component, elements, range.nodes_per_element, offsets.s.data(),
                      {out.x.data() + first, out.y.data() + first, out.z.data() + first});
    }
  });
}

// The sum of each element's nodes and its first moment, in nodes, from the middle. `known` as above.
template <int known, class T>
VEC_INLINE void moments_of(const T* x, int elements, int count, T* sum, T* moment) {
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
VEC_INLINE void moments(const T* x, int elements, int count, T* sum, T* moment) {
  if (count == 4) return moments_of<4>(x, elements, count, sum, moment);
  if (count == 5) return moments_of<5>(x, elements, count, sum, moment);
  moments_of<0>(x, elements, count, sum, moment);
}

// One component of the force f and of the torque spacing (n1 m2 - n2 m1) of each element.
template <class T>
struct ForceComponent {
  const T* f;
  const double* n1;
  const T* m2;
  const double* n2;
  const T* m1;
};
template <class T>
VEC_INLINE void add_component(const ForceComponent<T>& c, double spacing, int elements, T* force, T* torque) {
  for (int i = 0; i < elements; ++i) {
    force[i] += c.f[i];
    torque[i] +=
        static_cast<T>(spacing * (c.n1[i] * static_cast<double>(c.m2[i]) - c.n2[i] * static_cast<double>(c.m1[i])));
  }
}

template <class T>
VEC_INLINE void add_forces(const NodeInput& of, const NodeForces<T>& forces, ContactBuffer<T>& out) {
  T fx[block], fy[block], fz[block], mx[block], my[block], mz[block];
  for_ranges(of, [&](const WrittenRange& range, const NodeOffsets& offsets) VEC_ATTR {
    for (int from = range.begin; from < range.end; from += block) {
      const int elements = std::min(block, range.end - from), at = range.first_node(from),
                each = range.nodes_per_element;
      moments(forces.x.data() + at, elements, each, fx, mx);
      moments(forces.y.data() + at, elements, each, fy, my);
      moments(forces.z.data() + at, elements, each, fz, mz);
      const double spacing = offsets.spacing, *nx = of.axis.x.data() + from, *ny = of.axis.y.data() + from,
                   *nz = of.axis.z.data() + from;
      const auto to = [&](std::vector<T>& v) { return v.data() + from + range.element_shift; };
      add_component<T>({fx, ny, mz, nz, my}, spacing, elements, to(out.fx), to(out.tx));
      add_component<T>({fy, nz, mx, nx, mz}, spacing, elements, to(out.fy), to(out.ty));
      add_component<T>({fz, nx, my, ny, mx}, spacing, elements, to(out.fz), to(out.tz));
    }
  });
}

}  // namespace nodes

void PositionUnits(const NodeInput& of, double unit, NodePositions<std::int32_t>& out) {
  nodes::position(of, 1 / unit, out);
}
void PositionNm(const NodeInput& of, double unit, NodePositions<double>& out) {
  nodes::position(of, 1 / unit, out);
}
void AddFloats(const NodeInput& of, const NodeForces<float>& forces, ContactBuffer<float>& out) {
  nodes::add_forces(of, forces, out);
}
void AddDoubles(const NodeInput& of, const NodeForces<double>& forces, ContactBuffer<double>& out) {
  nodes::add_forces(of, forces, out);
}

}  // namespace ropewalk::VEC_SET
VEC_AFTER_NAMESPACE();

#if VEC_ONCE
namespace ropewalk {

VEC_EXPORT(PositionUnits);
VEC_EXPORT(PositionNm);
VEC_EXPORT(AddFloats);
VEC_EXPORT(AddDoubles);

void position_nodes(const NodeInput& of, double unit, NodePositions<std::int32_t>& out) {
  VEC_IN_USE(PositionUnits)(of, unit, out);
}
void position_nodes(const NodeInput& of, double unit, NodePositions<double>& out) {
  VEC_IN_USE(PositionNm)(of, unit, out);
}
void add_node_forces(const NodeInput& of, const NodeForces<float>& forces, ContactBuffer<float>& out) {
  VEC_IN_USE(AddFloats)(of, forces, out);
}
void add_node_forces(const NodeInput& of, const NodeForces<double>& forces, ContactBuffer<double>& out) {
  VEC_IN_USE(AddDoubles)(of, forces, out);
}

NodeOffsets node_offsets(int count, double length) {
  NodeOffsets out;
  for (int l = 0; l < count; ++l) out.s.push_back(line_node(l, count, length));
  out.s.resize(out.s.size() + NodeOffsets::padding);
  out.spacing = length / count;
  return out;
}

}  // namespace ropewalk
#endif  // VEC_ONCE
