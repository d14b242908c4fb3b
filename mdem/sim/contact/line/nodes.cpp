#include "sim/contact/line/nodes.hpp"

#include "sim/state/prefetch.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sim/contact/line/nodes.cpp"
#include <hwy/foreach_target.h>
//
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace ropewalk::HWY_NAMESPACE {
namespace rows {
namespace hn = hwy::HWY_NAMESPACE;

constexpr int block = 32;  // elements whose places or sums stay in the first cache

// Added to a number it leaves the nearest integer, of 32 bits, in front of the last 16 bits: 1.5 * 2^36, and a half
// as they are cut off.
constexpr int behind_point = 16;
template <class C>
constexpr double rounds = sizeof(C) == 4 ? 103079215104.5 : 0.0;

template <class D>
HWY_INLINE void store(D, hn::Vec<D> v, std::int32_t* to) {
  const hn::RebindToUnsigned<D> bits;
  const hn::Rebind<std::uint32_t, D> low;
  const hn::Rebind<std::int32_t, D> coordinate;
  const auto number = hn::TruncateTo(low, hn::ShiftRight<behind_point>(hn::BitCast(bits, v)));
  hn::StoreU(hn::BitCast(coordinate, number), coordinate, to);
}
template <class D>
HWY_INLINE void store(D d, hn::Vec<D> v, double* to) {
  hn::StoreU(v, d, to);
}

// One component of consecutive elements, in units of the nodes: of the centres and of the axes.
struct Line {
  double centre[block], along[block];

  template <class C>
  HWY_INLINE void take(const double* x, const double* n, double per_unit, int elements) {
    for (int i = 0; i < elements; ++i) {
      centre[i] = x[i] * per_unit + rounds<C>;
      along[i] = n[i] * per_unit;
    }
  }
};

// The nodes of an element fill some vectors, but for lanes at the end of the last one: the next element's nodes are
// stored over these. A count known to the compiler keeps the places in registers.
template <int known, class D, class C>
HWY_INLINE void place_row(D d, const Line (&lines)[3], int elements, int each, const double* s, C* const (&to)[3]) {
  constexpr int lanes = static_cast<int>(hn::MaxLanes(D()));
  const int vectors = known > 0 ? known : (each + lanes - 1) / lanes;
  for (int i = 0, at = 0; i < elements; ++i, at += each)
    for (int c = 0; c < 3; ++c) {
      const auto centre = hn::Set(d, lines[c].centre[i]), along = hn::Set(d, lines[c].along[i]);
      for (int v = 0; v < vectors; ++v)
        store(d, hn::MulAdd(hn::LoadU(d, s + v * lanes), along, centre), to[c] + at + v * lanes);
    }
}

template <class C>
HWY_INLINE void place_row(const Line (&lines)[3], int elements, int each, const double* s, C* const (&to)[3]) {
  const hn::CappedTag<double, 4> narrow;
  const hn::CappedTag<double, NodePlaces::room> wide;
  if (each <= static_cast<int>(hn::MaxLanes(narrow))) return place_row<1>(narrow, lines, elements, each, s, to);
  if (each <= static_cast<int>(hn::MaxLanes(wide))) return place_row<1>(wide, lines, elements, each, s, to);
  place_row<0>(wide, lines, elements, each, s, to);
}

// What a part has of one kind of rows.
struct PartRow {
  int first, elements, each;  // its first node; nodes of each element
  const NodePlaces& places;
};
template <class What>
HWY_INLINE void for_rows(const RowsOf& of, const What& what) {
  for (std::size_t p = 0; p < of.chunk.parts.size(); ++p) {
    const TouchedPart& part = of.chunk.parts[p];
    const auto type = static_cast<std::size_t>(of.tube_type[static_cast<std::size_t>(part.tube)]);
    for (std::size_t kind = 0; kind < row_kinds; ++kind) {
      const TouchedPart::Row& row = part.row[kind];
      if (row.per_element > 0)
        what(p, kind,
             PartRow{row.first(part.begin), part.end - part.begin, row.per_element, of.places[kind][type]});
    }
  }
}

template <class C>
HWY_INLINE void place(const RowsOf& of, LineNodes<C>* rows) {
  Line lines[3];
  const double *x[] = {of.position.x.data(), of.position.y.data(), of.position.z.data()},
               *n[] = {of.axis.x.data(), of.axis.y.data(), of.axis.z.data()};
  constexpr int ahead = 4;  // parts
  const TouchedPart* const last = of.chunk.parts.data() + of.chunk.parts.size();
  for (const TouchedPart* next = of.chunk.parts.data(); next != last; ++next) {
    if (last - next > ahead)
      for (const Vec3Array* v : {&of.position, &of.axis}) ask_for(*v, next[ahead].begin, next[ahead].end);
    const TouchedPart& part = *next;
    if (!may_be_in_reach(part.beyond, of.moved)) continue;
    const auto type = static_cast<std::size_t>(of.tube_type[static_cast<std::size_t>(part.tube)]);
    for (int from = part.begin; from < part.end; from += block) {
      const int elements = std::min(block, part.end - from);
      for (int c = 0; c < 3; ++c) lines[c].take<C>(x[c] + from, n[c] + from, rows->per_unit, elements);
      for (std::size_t kind = 0; kind < row_kinds; ++kind) {
        const TouchedPart::Row& row = part.row[kind];
        LineNodes<C>& to = rows[kind];
        const int first = row.first(from);
        if (row.per_element > 0)
          place_row<C>(lines, elements, row.per_element, of.places[kind][type].s.data(),
                       {to.x.data() + first, to.y.data() + first, to.z.data() + first});
      }
    }
  }
}

// The sum of each element's nodes and its first moment, in nodes, from the middle. `known` as above.
template <int known, class T>
HWY_INLINE void moments_of(const T* x, int elements, int count, T* sum, T* moment) {
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
HWY_INLINE void moments(const T* x, int elements, int count, T* sum, T* moment) {
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
HWY_INLINE void add_component(const Component<T>& c, double step, int elements, T* force, T* torque) {
  for (int i = 0; i < elements; ++i) {
    force[i] += c.f[i];
    torque[i] +=
        static_cast<T>(step * (c.n1[i] * static_cast<double>(c.m2[i]) - c.n2[i] * static_cast<double>(c.m1[i])));
  }
}

template <class T>
HWY_INLINE void add_forces(const RowsOf& of, const NodeForces<T>* forces, ContactBuffer<T>& out) {
  T fx[block], fy[block], fz[block], mx[block], my[block], mz[block];
  for_rows(of, [&](std::size_t p, std::size_t kind, const PartRow& row) HWY_ATTR {
    const NodeForces<T>& f = forces[kind];
    if (!f.used[p]) return;
    const int from = of.chunk.parts[p].begin, entry = from + of.chunk.parts[p].element_shift;
    for (int k = 0; k < row.elements; k += block) {
      const int elements = std::min(block, row.elements - k), at = row.first + k * row.each;
      moments(f.x.data() + at, elements, row.each, fx, mx);
      moments(f.y.data() + at, elements, row.each, fy, my);
      moments(f.z.data() + at, elements, row.each, fz, mz);
      const double step = row.places.step, *nx = of.axis.x.data() + from + k, *ny = of.axis.y.data() + from + k,
                   *nz = of.axis.z.data() + from + k;
      const auto to = [&](std::vector<T>& v) { return v.data() + entry + k; };
      add_component<T>({fx, ny, mz, nz, my}, step, elements, to(out.fx), to(out.tx));
      add_component<T>({fy, nz, mx, nx, mz}, step, elements, to(out.fy), to(out.ty));
      add_component<T>({fz, nx, my, ny, mx}, step, elements, to(out.fz), to(out.tz));
    }
  });
}

}  // namespace rows

void PlaceUnits(const RowsOf& of, LineNodes<std::int32_t>* nodes) { rows::place(of, nodes); }
void PlaceNm(const RowsOf& of, LineNodes<double>* nodes) { rows::place(of, nodes); }
void AddFloats(const RowsOf& of, const NodeForces<float>* forces, ContactBuffer<float>& out) {
  rows::add_forces(of, forces, out);
}
void AddDoubles(const RowsOf& of, const NodeForces<double>* forces, ContactBuffer<double>& out) {
  rows::add_forces(of, forces, out);
}

}  // namespace ropewalk::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace ropewalk {

HWY_EXPORT(PlaceUnits);
HWY_EXPORT(PlaceNm);
HWY_EXPORT(AddFloats);
HWY_EXPORT(AddDoubles);

void place_nodes(const RowsOf& of, LineNodes<std::int32_t>* rows) { HWY_DYNAMIC_DISPATCH(PlaceUnits)(of, rows); }
void place_nodes(const RowsOf& of, LineNodes<double>* rows) { HWY_DYNAMIC_DISPATCH(PlaceNm)(of, rows); }
void add_node_forces(const RowsOf& of, const NodeForces<float>* forces, ContactBuffer<float>& out) {
  HWY_DYNAMIC_DISPATCH(AddFloats)(of, forces, out);
}
void add_node_forces(const RowsOf& of, const NodeForces<double>* forces, ContactBuffer<double>& out) {
  HWY_DYNAMIC_DISPATCH(AddDoubles)(of, forces, out);
}

NodePlaces node_places(int count, double length) {
  NodePlaces out;
  for (int l = 0; l < count; ++l) out.s.push_back(line_node(l, count, length));
  out.s.resize(out.s.size() + NodePlaces::room);
  out.step = length / count;
  return out;
}

}  // namespace ropewalk
#endif  // HWY_ONCE
