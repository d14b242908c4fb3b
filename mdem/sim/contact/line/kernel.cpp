// The kernel of the line law, for every instruction set that the compiler knows and in two precisions; the
// machine's best is picked at run time. The arithmetic of u is in the tables (radial_table.hpp).
//
// One element i at a time against vectors of consecutive nodes of its neighbours, at separations d from the centre
// of i. The nodes of i are at s_k n, so that all of them share |d|^2 and d.n:
//   X_k = |d - s_k n|^2 = |d|^2 + s_k^2 - 2 s_k d.n,   g_k = -2/delta u'(y(X_k)) w   (force per separation)
//   force on the node  f = sum_k g_k (d - s_k n) = A d - B n,   A = sum_k g_k,   B = sum_k s_k g_k
//   on i: force -sum f, torque sum_k s_k n x (-g_k (d - s_k n)) = -n x sum B d
#include <type_traits>

#include "sim/contact/line/engine.hpp"
#include "sim/threads/vector_unit.hpp"

#undef VEC_SOURCE
#define VEC_SOURCE "sim/contact/line/kernel.cpp"
#include "sim/vectors/each_set-inl.hpp"
//
#include "sim/vectors/operations-inl.hpp"

VEC_BEFORE_NAMESPACE();
namespace ropewalk::VEC_SET {
namespace ops = vec::VEC_SET;

// Vectors of a precision. Coordinates of `float` are whole numbers modulo 2^32 (sim/contact/shared/wrapped.hpp).
template <class T>
struct Lanes;
template <>
struct Lanes<float> {
  using D = ops::CappedTag<float, 16>;
  static VEC_INLINE std::int32_t coordinate(double x) { return static_cast<std::int32_t>(std::llrint(x)); }
  static VEC_INLINE ops::Vec<D> difference(const std::int32_t* x, std::int32_t from) {
    const ops::RebindToUnsigned<D> modulo;
    const auto to = ops::Load(modulo, reinterpret_cast<const std::uint32_t*>(x)),
               apart = ops::Sub(to, ops::Set(modulo, static_cast<std::uint32_t>(from)));
    return ops::ConvertTo(D(), ops::BitCast(ops::RebindToSigned<D>(), apart));
  }
};
template <>
struct Lanes<double> {
  using D = ops::CappedTag<double, 8>;
  static VEC_INLINE double coordinate(double x) { return x; }
  static VEC_INLINE ops::Vec<D> difference(const double* x, double from) {
    const D d;
    return ops::Sub(ops::Load(d, x), ops::Set(d, from));
  }
};

// Entries of a table row by the low bits of the index.
template <class D, class I, class T, int segments>
VEC_INLINE ops::Vec<D> look_up(D d, const T (&row)[segments], I index) {
  const auto entry = ops::And(index, ops::Set(ops::RebindToSigned<D>(), segments - 1));
#if VEC_TARGET <= VEC_AVX512
  if constexpr (sizeof(T) == 4 && segments == 16)
    return ops::Vec<D>{_mm512_permutexvar_ps(reinterpret_cast<__m512i>(index.raw), ops::Load(d, row).raw)};
#elif VEC_TARGET == VEC_AVX2
  if constexpr (sizeof(T) == 4 && segments == 4)
    return ops::Vec<D>{_mm256_permutevar_ps(ops::LoadDup128(d, row).raw, reinterpret_cast<__m256i>(index.raw))};
#else
  if constexpr (sizeof(T) == 4 && segments == 4) return ops::TableLookupLanes(ops::Load(d, row), entry);
#endif
  return ops::GatherIndex(d, row, entry);
}

// A squared distance X in either form of the polynomials (radial_table.hpp): the segment or piece that holds there,
// and the variable in it. `sum_up` evaluates K of them at once, so that the processor need not wait for one.
template <class D>
struct InTable {
  using V = ops::Vec<D>;
  ops::Vec<ops::RebindToSigned<D>> index;
  V s;

  template <class Table>
  static VEC_INLINE const auto& of(const Table& t) {
    return t;
  }
  template <class T, int segments, int degree>
  VEC_INLINE void find(D d, const RadialTable<T, segments, degree>& t, V X) {
    constexpr int left = RadialTable<T, segments, degree>::mantissa_left;
    const auto y = ops::MulAdd(X, ops::Set(d, t.scale), ops::Set(d, t.shift));
    index = ops::ShiftRight<left>(ops::BitCast(ops::RebindToSigned<D>(), y));
    s = ops::Sub(y, ops::BitCast(d, ops::ShiftLeft<left>(index)));
  }
  // du/dy from the polynomial of d.
  VEC_INLINE V slope(V sum) const { return sum; }

  template <int K, std::size_t terms, class Row>
  static VEC_INLINE void sum_up(D d, const Row (&row)[terms], const InTable (&at)[K], V (&sum)[K]) {
    for (int k = 0; k < K; ++k) sum[k] = look_up(d, row[terms - 1], at[k].index);
    for (std::size_t m = terms - 1; m-- > 0;)
      for (int k = 0; k < K; ++k) sum[k] = ops::MulAdd(sum[k], at[k].s, look_up(d, row[m], at[k].index));
  }
};

template <class D>
struct InPieces {
  using V = ops::Vec<D>;
  ops::Vec<ops::RebindToSigned<D>> index;
  V s, s2, w2;

  static VEC_INLINE const auto& of(const MixedTable& t) { return t.pieces; }
  template <class T, int degree>
  VEC_INLINE void find(D d, const RadialPieces<T, degree>& t, V X) {
    const auto w = ops::Div(ops::Set(d, t.width), ops::Sub(X, ops::Set(d, t.pole)));
    const auto within = [&](int k) {  // -1 or 0
      return ops::BitCast(ops::RebindToSigned<D>(), ops::VecFromMask(d, ops::Lt(X, ops::Set(d, t.edge[k]))));
    };
    index = ops::Add(within(0), ops::Add(within(1), within(2)));
    s = ops::Sub(w, look_up(d, t.middle, index));
    s2 = ops::Mul(s, s);
    w2 = ops::Mul(w, w);
  }
  VEC_INLINE V slope(V sum) const { return ops::Mul(sum, w2); }

  // Two terms at a time: the steps that wait for each other take longer than all of them.
  template <int K, std::size_t terms, class Row>
  static VEC_INLINE void sum_up(D d, const Row (&row)[terms], const InPieces (&at)[K], V (&sum)[K]) {
    constexpr std::size_t even = terms / 2 * 2;
    const auto two = [&](std::size_t m, int k) {
      return ops::MulAdd(look_up(d, row[m + 1], at[k].index), at[k].s, look_up(d, row[m], at[k].index));
    };
    for (int k = 0; k < K; ++k) {
      sum[k] = two(even - 2, k);
      if constexpr (terms > even) sum[k] = ops::MulAdd(look_up(d, row[even], at[k].index), at[k].s2, sum[k]);
    }
    for (std::size_t m = even - 2; m > 0; m -= 2)
      for (int k = 0; k < K; ++k) sum[k] = ops::MulAdd(sum[k], at[k].s2, two(m - 2, k));
  }
};

// The form that costs less: that of pieces where an instruction set looks up among few entries only.
template <class Table, class D>
using Form =
    std::conditional_t<(VEC_TARGET > VEC_AVX512) && std::is_same_v<Table, MixedTable>, InPieces<D>, InTable<D>>;

// For K vectors of squared distances X: du/dy and, if wanted, u; zero from the cutoff on.
template <bool energies, int K, class D, class Table>
VEC_INLINE void radial(D d, const Table& t, const ops::Vec<D> (&X)[K], ops::Vec<D> (&u)[K],
                       ops::Vec<D> (&slope)[K]) {
  using T = typename Table::Value;
  using At = Form<Table, D>;
  const auto& form = At::of(t);
  const auto cutoff2 = ops::Set(d, t.cutoff2), core2 = ops::Set(d, t.core2);
  At at[K];
  auto nearest = X[0];
  for (int k = 0; k < K; ++k) {
    at[k].find(d, form, X[k]);
    if (k > 0) nearest = ops::Min(nearest, X[k]);
  }
  ops::Vec<D> sum[K];
  At::sum_up(d, form.d, at, sum);
  for (int k = 0; k < K; ++k) slope[k] = ops::IfThenElseZero(ops::Lt(X[k], cutoff2), at[k].slope(sum[k]));
  if constexpr (energies) {
    At::sum_up(d, form.c, at, sum);
    for (int k = 0; k < K; ++k) u[k] = ops::IfThenElseZero(ops::Lt(X[k], cutoff2), sum[k]);
  }
  if (__builtin_expect(ops::AllFalse(d, ops::Lt(nearest, core2)), true)) return;
  for (int k = 0; k < K; ++k) {
    const auto in_core = ops::Lt(X[k], core2);
    const auto rho = ops::Sqrt(ops::Max(X[k], ops::Set(d, static_cast<T>(1e-12) / (t.unit * t.unit))));
    const auto e = ops::Sub(ops::Mul(rho, ops::Set(d, t.unit)), ops::Set(d, t.contact + t.core));
    const auto v1 = ops::Set(d, t.v1), v2 = ops::Set(d, t.v2);
    if constexpr (energies)
      u[k] = ops::IfThenElse(
          in_core,
          ops::MulAdd(e, ops::MulAdd(ops::Mul(e, ops::Set(d, static_cast<T>(0.5))), v2, v1), ops::Set(d, t.v0)),
          u[k]);
    // du/dy = du/drho unit/(2 rho scale), rho in units.
    const auto of_core =
        ops::Div(ops::Mul(ops::MulAdd(e, v2, v1), ops::Set(d, t.unit)), ops::Mul(rho, ops::Set(d, 2 * t.scale)));
    slope[k] = ops::IfThenElse(in_core, of_core, slope[k]);
  }
}

// The contact of one element. N is the number of its nodes where the compiler knows it, or 0.
template <bool energies, int N, class In>
struct ElementContact {
  using Table = typename In::Table;
  using T = typename Table::Value;
  using L = Lanes<T>;
  using D = typename L::D;
  using V = ops::Vec<D>;
  static constexpr int lanes = static_cast<int>(ops::Lanes(D()));
  // Pairs of opposite nodes of the element whose polynomials are evaluated at once: as many as the registers hold.
  static constexpr int at_once = VEC_TARGET <= VEC_AVX512 && N > 0 ? std::min(N / 2, 3) : 1;

  const In& in;
  typename In::Coordinate centre[3];
  V n[3];                 // its axis
  V force[3], moment[3];  // sums over the nodes of the neighbours, lane by lane
  V energy;

  VEC_INLINE ElementContact(const In& input, std::size_t element) : in(input) {
    const D d;
    const Vec3Array &x = in.state->position, &axis = *in.axis;
    const double position[3] = {x.x[element], x.y[element], x.z[element]},
                 along[3] = {axis.x[element], axis.y[element], axis.z[element]};
    for (int a = 0; a < 3; ++a) {
      centre[a] = L::coordinate(position[a] * in.per_unit);
      n[a] = ops::Set(d, static_cast<T>(along[a]));
      force[a] = moment[a] = ops::Zero(d);
    }
    energy = ops::Zero(d);
  }

  // One vector of nodes: separations, their squares, and their parts along the axis.
  struct Nodes {
    V separation[3], square, along;
  };
  VEC_INLINE Nodes nodes_at(int first) const {
    const auto at = static_cast<std::size_t>(first);
    const V x = L::difference(in.nodes->x.data() + at, centre[0]),
            y = L::difference(in.nodes->y.data() + at, centre[1]),
            z = L::difference(in.nodes->z.data() + at, centre[2]);
    return {{x, y, z},
            ops::MulAdd(x, x, ops::MulAdd(y, y, ops::Mul(z, z))),
            ops::MulAdd(n[0], x, ops::MulAdd(n[1], y, ops::Mul(n[2], z)))};
  }
  // Marks nodes within the cutoff of the element's axis between its first and its last node.
  VEC_INLINE std::uint64_t near(const Nodes& nodes, int count, const PairTables<Table>& pair) const {
    const D d;
    const V ahead = ops::Max(ops::Sub(ops::Abs(nodes.along), ops::Set(d, pair.half)), ops::Zero(d));
    const V least = ops::MulAdd(ahead, ahead, ops::NegMulAdd(nodes.along, nodes.along, nodes.square));
    return ops::bits_of_mask(d, ops::And(ops::Lt(least, ops::Set(d, pair.table.cutoff2)), ops::FirstN(d, count)));
  }

  // Sums over nodes of the element: A and B, and the energy.
  struct NodeSums {
    V A, B, u;
  };
  // Nodes at s[k] and -s[k], which share |d|^2 + s^2, and where `middle` the one at the centre.
  template <int pairs, bool middle>
  VEC_INLINE void add_nodes(const Table& table, const T* s, V square, V twice_along, NodeSums& sums) {
    constexpr int K = 2 * pairs + middle;
    const D d;
    V X[K], u[K], slope[K];
    for (int k = 0; k < pairs; ++k) {
      const V sk = ops::Set(d, s[k]), either = ops::Add(square, ops::Set(d, s[k] * s[k]));
      X[2 * k] = ops::NegMulAdd(sk, twice_along, either);
      X[2 * k + 1] = ops::MulAdd(sk, twice_along, either);
    }
    if constexpr (middle) X[K - 1] = square;
    radial<energies>(d, table, X, u, slope);
    if constexpr (middle) sums.A = ops::Add(sums.A, slope[K - 1]);
    for (int k = 0; k < pairs; ++k) {
      sums.A = ops::Add(sums.A, ops::Add(slope[2 * k], slope[2 * k + 1]));
      sums.B = ops::MulAdd(ops::Set(d, s[k]), ops::Sub(slope[2 * k], slope[2 * k + 1]), sums.B);
    }
    if constexpr (energies)
      for (int k = 0; k < K; ++k) sums.u = ops::Add(sums.u, u[k]);
  }
  VEC_INLINE void add_nodes_of_element(const PairTables<Table>& pair, V square, V twice_along, NodeSums& sums) {
    const int nodes = N > 0 ? N : static_cast<int>(pair.s.size());
    const T* const s = pair.s.data() + (nodes + 1) / 2;
    int k = 0;
    if constexpr (N % 2 == 1) {
      add_nodes<at_once, true>(pair.table, s, square, twice_along, sums);
      k = at_once;
    } else if constexpr (N == 0) {
      if (nodes % 2 == 1) add_nodes<0, true>(pair.table, s, square, twice_along, sums);
    }
    for (; k + at_once <= nodes / 2; k += at_once)
      add_nodes<at_once, false>(pair.table, s + k, square, twice_along, sums);
  }

  // Keeps the vectors of nodes of a span of which some are in reach. The sums over them come later: so the many
  // operations of one vector that wait for each other overlap with those of the next.
  VEC_INLINE void find(int first, int count, const PairTables<Table>& pair, NodeVectors<T>& found) const {
    const D d;
    for (const int end = first + count; first < end; first += lanes) {
      Nodes nodes = nodes_at(first);
      const std::uint64_t bits = near(nodes, end - first, pair);
      if (bits == 0) continue;
      const int skip = static_cast<int>(vec::first_bit(bits));
      if ((end - first - 1) / lanes > (end - first - skip - 1) / lanes) {  // spares the last vector
        first += skip;
        nodes = nodes_at(first);
      }
      T* const to = found.add(first, lanes);
      for (int a = 0; a < 3; ++a) ops::Store(nodes.separation[a], d, to + a * lanes);
      // Lanes of no node of this span are put out of reach.
      const auto own = ops::FirstN(d, end - first);
      ops::Store(ops::IfThenElse(own, nodes.square, ops::Set(d, pair.far2)), d, to + 3 * lanes);
      ops::Store(ops::Add(nodes.along, nodes.along), d, to + 4 * lanes);
    }
  }

  VEC_INLINE void sum(const NodeVectors<T>& found, const PairTables<Table>& pair, NodeForces<T>& forces) {
    const D d;
    const V zero = ops::Zero(d), weight = ops::Set(d, pair.weight);
    for (int v = 0; v < found.count; ++v) {
      const T* const nodes = found.at(v, lanes);
      NodeSums sums{zero, zero, zero};
      add_nodes_of_element(pair, ops::Load(d, nodes + 3 * lanes), ops::Load(d, nodes + 4 * lanes), sums);
      const V A = ops::Mul(sums.A, weight), B = ops::Mul(sums.B, weight);
      if constexpr (energies) energy = ops::MulAdd(sums.u, ops::Set(d, pair.energy_weight), energy);
      const auto first = static_cast<std::size_t>(found.first[static_cast<std::size_t>(v)]);
      T* const on[3] = {forces.x.data() + first, forces.y.data() + first, forces.z.data() + first};
      for (int a = 0; a < 3; ++a) {
        const V separation = ops::Load(d, nodes + a * lanes);
        const V f = ops::NegMulAdd(B, n[a], ops::Mul(A, separation));
        ops::Store(ops::Add(ops::Load(d, on[a]), f), d, on[a]);
        force[a] = ops::Add(force[a], f);
        moment[a] = ops::MulAdd(B, separation, moment[a]);
      }
    }
  }

  VEC_INLINE void give(std::size_t element, std::size_t at, ContactBuffer<T>& out) const {
    double f[3], m[3];
    for (int a = 0; a < 3; ++a) {
      const auto [of_force, of_moment] = ops::SumsOfLanes(force[a], moment[a]);
      f[a] = static_cast<double>(of_force);
      m[a] = static_cast<double>(of_moment) * in.unit;
    }
    const double nx = in.axis->x[element], ny = in.axis->y[element], nz = in.axis->z[element];
    out.fx[at] -= static_cast<T>(f[0]);
    out.fy[at] -= static_cast<T>(f[1]);
    out.fz[at] -= static_cast<T>(f[2]);
    out.tx[at] -= static_cast<T>(ny * m[2] - nz * m[1]);
    out.ty[at] -= static_cast<T>(nz * m[0] - nx * m[2]);
    out.tz[at] -= static_cast<T>(nx * m[1] - ny * m[0]);
    if constexpr (energies) out.energy += static_cast<double>(ops::SumOfLanes(energy));
  }
};

template <bool energies, int N, class In, class T>
VEC_NOINLINE void segment_contact(const In& in, const LineChunk& chunk, const Segment& own, LineWork<T>& work,
                                  ContactBuffer<T>& out) {
  const auto types = static_cast<int>(in.topology->types.size());
  const auto* pairs = in.pairs + in.topology->tube_type[static_cast<std::size_t>(own.tube)] * types;
  RangeOf range_of(chunk);
  for (int i = own.begin; i < own.end; ++i) {
    const auto spans = in.list->spans(i);
    if (spans.begin() == spans.end()) continue;
    const auto element = static_cast<std::size_t>(i);
    ElementContact<energies, N, In> contact(in, element);
    for (int other = 0; other < types; ++other) {
      work.found.count = 0;
      for (const NeighbourSpan& span : spans)
        if (span.type == other && span.may_be_in_reach(in.moved))
          contact.find(chunk.ranges[static_cast<std::size_t>(span.range)].first_node(span.first) + span.node_from,
                       span.nodes, pairs[other], work.found);
      contact.sum(work.found, pairs[other], work.forces);
    }
    contact.give(element, static_cast<std::size_t>(i + range_of(i).element_shift), out);
  }
}

// The numbers of nodes that the shipped sets have are known to the compiler.
template <bool energies, class In, class T>
VEC_INLINE void chunk_contact(const In& in, const LineChunk& chunk, LineWork<T>& work, ContactBuffer<T>& out) {
  for (const Segment& own : chunk.own) {
    const int nodes = in.list->nodes_per_element(in.topology->tube_type[static_cast<std::size_t>(own.tube)]);
    if constexpr (sizeof(T) == 4) {
      if (nodes == 4) {
        segment_contact<energies, 4>(in, chunk, own, work, out);
        continue;
      }
      if (nodes == 5) {
        segment_contact<energies, 5>(in, chunk, own, work, out);
        continue;
      }
      if (nodes == 6) {
        segment_contact<energies, 6>(in, chunk, own, work, out);
        continue;
      }
    }
    segment_contact<energies, 0>(in, chunk, own, work, out);
  }
}

void Mixed(const LineKernelInput<MixedTable, std::int32_t>& in, const LineChunk& chunk, LineWork<float>& work,
           ContactBuffer<float>& out) {
  in.energies ? chunk_contact<true>(in, chunk, work, out) : chunk_contact<false>(in, chunk, work, out);
}

void Full(const LineKernelInput<FullTable, double>& in, const LineChunk& chunk, LineWork<double>& work,
          ContactBuffer<double>& out) {
  in.energies ? chunk_contact<true>(in, chunk, work, out) : chunk_contact<false>(in, chunk, work, out);
}

}  // namespace ropewalk::VEC_SET
VEC_AFTER_NAMESPACE();

#if VEC_ONCE
namespace ropewalk {

VEC_EXPORT(Mixed);
VEC_EXPORT(Full);

void line_contact(const LineKernelInput<MixedTable, std::int32_t>& in, const LineChunk& chunk,
                  LineWork<float>& work, ContactBuffer<float>& out) {
  VEC_IN_USE(Mixed)(in, chunk, work, out);
}

void line_contact(const LineKernelInput<FullTable, double>& in, const LineChunk& chunk, LineWork<double>& work,
                  ContactBuffer<double>& out) {
  VEC_IN_USE(Full)(in, chunk, work, out);
}

}  // namespace ropewalk
#endif  // VEC_ONCE
