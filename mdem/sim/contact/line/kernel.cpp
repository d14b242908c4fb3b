// The kernel of the line law, for every instruction set that the compiler knows and in two precisions; the
// machine's best is picked at run time. The arithmetic of u is in the tables (radial_table.hpp).
//
// One element i at a time against vectors of consecutive nodes of its neighbours, at separations d from the centre
// of i. The nodes of i are at s_k n, so that all of them share |d|^2 and d.n:
//   X_k = |d - s_k n|^2 = |d|^2 + s_k (s_k - 2 d.n),   g_k = -2/delta u'(y(X_k)) w   (force per separation)
//   force on the node  f = sum_k g_k (d - s_k n) = A d - B n,   A = sum_k g_k,   B = sum_k s_k g_k
//   on i: force -sum f, torque sum_k s_k n x (-g_k (d - s_k n)) = -n x sum B d
#include <type_traits>

#include "sim/contact/line/engine.hpp"
#include "sim/threads/vector_unit.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sim/contact/line/kernel.cpp"
#include <hwy/foreach_target.h>
//
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace ropewalk::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Vectors of a precision. Coordinates of `float` are 32-bit integers, so that differences are exact.
template <class T>
struct Lanes;
template <>
struct Lanes<float> {
  using D = hn::CappedTag<float, 16>;
  static HWY_INLINE std::int32_t coordinate(double x) { return static_cast<std::int32_t>(std::lrint(x)); }
  static HWY_INLINE hn::Vec<D> difference(const std::int32_t* x, std::int32_t from) {
    const hn::RebindToSigned<D> di;
    return hn::ConvertTo(D(), hn::Sub(hn::LoadU(di, x), hn::Set(di, from)));
  }
};
template <>
struct Lanes<double> {
  using D = hn::CappedTag<double, 8>;
  static HWY_INLINE double coordinate(double x) { return x; }
  static HWY_INLINE hn::Vec<D> difference(const double* x, double from) {
    const D d;
    return hn::Sub(hn::LoadU(d, x), hn::Set(d, from));
  }
};

// Entries of a table row by the low bits of the index.
template <class D, class I, class T, int segments>
HWY_INLINE hn::Vec<D> look_up(D d, const T (&row)[segments], I index) {
  const auto entry = hn::And(index, hn::Set(hn::RebindToSigned<D>(), segments - 1));
#if HWY_TARGET <= HWY_AVX3
  if constexpr (sizeof(T) == 4 && segments == 16)
    return hn::Vec<D>{_mm512_permutexvar_ps(index.raw, hn::Load(d, row).raw)};
#elif HWY_TARGET == HWY_AVX2
  if constexpr (sizeof(T) == 4 && segments == 4)
    return hn::Vec<D>{_mm256_permutevar_ps(hn::LoadDup128(d, row).raw, index.raw)};
#elif HWY_TARGET != HWY_SCALAR
  if constexpr (sizeof(T) == 4 && segments == 4)
    return hn::TableLookupLanes(hn::Load(d, row), hn::IndicesFromVec(d, entry));
#endif
  return hn::GatherIndex(d, row, entry);
}

// A squared distance X in either form of the polynomials (radial_table.hpp): the segment or piece that holds there,
// and the variable in it. `sum_up` evaluates K of them at once, so that the processor need not wait for one.
template <class D>
struct InTable {
  using V = hn::Vec<D>;
  hn::Vec<hn::RebindToSigned<D>> index;
  V s;

  template <class Table>
  static HWY_INLINE const auto& of(const Table& t) {
    return t;
  }
  template <class T, int segments, int degree>
  HWY_INLINE void find(D d, const RadialTable<T, segments, degree>& t, V X) {
    constexpr int left = RadialTable<T, segments, degree>::mantissa_left;
    const auto y = hn::MulAdd(X, hn::Set(d, t.scale), hn::Set(d, t.shift));
    index = hn::ShiftRight<left>(hn::BitCast(hn::RebindToSigned<D>(), y));
    s = hn::Sub(y, hn::BitCast(d, hn::ShiftLeft<left>(index)));
  }
  // du/dy from the polynomial of d.
  HWY_INLINE V slope(V sum) const { return sum; }

  template <int K, std::size_t terms, class Row>
  static HWY_INLINE void sum_up(D d, const Row (&row)[terms], const InTable (&at)[K], V (&sum)[K]) {
    for (int k = 0; k < K; ++k) sum[k] = look_up(d, row[terms - 1], at[k].index);
    for (std::size_t m = terms - 1; m-- > 0;)
      for (int k = 0; k < K; ++k) sum[k] = hn::MulAdd(sum[k], at[k].s, look_up(d, row[m], at[k].index));
  }
};

template <class D>
struct InPieces {
  using V = hn::Vec<D>;
  hn::Vec<hn::RebindToSigned<D>> index;
  V s, s2, w2;

  static HWY_INLINE const auto& of(const MixedTable& t) { return t.pieces; }
  template <class T, int degree>
  HWY_INLINE void find(D d, const RadialPieces<T, degree>& t, V X) {
    const auto w = hn::Div(hn::Set(d, t.width), hn::Sub(X, hn::Set(d, t.pole)));
    const auto within = [&](int k) {  // -1 or 0
      return hn::BitCast(hn::RebindToSigned<D>(), hn::VecFromMask(d, hn::Lt(X, hn::Set(d, t.edge[k]))));
    };
    index = hn::Add(within(0), hn::Add(within(1), within(2)));
    s = hn::Sub(w, look_up(d, t.middle, index));
    s2 = hn::Mul(s, s);
    w2 = hn::Mul(w, w);
  }
  HWY_INLINE V slope(V sum) const { return hn::Mul(sum, w2); }

  // Two terms at a time: the steps that wait for each other take longer than all of them.
  template <int K, std::size_t terms, class Row>
  static HWY_INLINE void sum_up(D d, const Row (&row)[terms], const InPieces (&at)[K], V (&sum)[K]) {
    constexpr std::size_t even = terms / 2 * 2;
    const auto two = [&](std::size_t m, int k) {
      return hn::MulAdd(look_up(d, row[m + 1], at[k].index), at[k].s, look_up(d, row[m], at[k].index));
    };
    for (int k = 0; k < K; ++k) {
      sum[k] = two(even - 2, k);
      if constexpr (terms > even) sum[k] = hn::MulAdd(look_up(d, row[even], at[k].index), at[k].s2, sum[k]);
    }
    for (std::size_t m = even - 2; m > 0; m -= 2)
      for (int k = 0; k < K; ++k) sum[k] = hn::MulAdd(sum[k], at[k].s2, two(m - 2, k));
  }
};

// The form that costs less: that of pieces where an instruction set looks up among few entries only.
template <class Table, class D>
using Form =
    std::conditional_t<(HWY_TARGET > HWY_AVX3) && std::is_same_v<Table, MixedTable>, InPieces<D>, InTable<D>>;

// Of K vectors of squared distances X: du/dy and, if wanted, u; zero from the cutoff on.
template <bool energies, int K, class D, class Table>
HWY_INLINE void radial(D d, const Table& t, const hn::Vec<D> (&X)[K], hn::Vec<D> (&u)[K], hn::Vec<D> (&slope)[K]) {
  using T = typename Table::Value;
  using At = Form<Table, D>;
  const auto& form = At::of(t);
  const auto cutoff2 = hn::Set(d, t.cutoff2), core2 = hn::Set(d, t.core2);
  At at[K];
  auto nearest = X[0];
  for (int k = 0; k < K; ++k) {
    at[k].find(d, form, X[k]);
    if (k > 0) nearest = hn::Min(nearest, X[k]);
  }
  hn::Vec<D> sum[K];
  At::sum_up(d, form.d, at, sum);
  for (int k = 0; k < K; ++k) slope[k] = hn::IfThenElseZero(hn::Lt(X[k], cutoff2), at[k].slope(sum[k]));
  if constexpr (energies) {
    At::sum_up(d, form.c, at, sum);
    for (int k = 0; k < K; ++k) u[k] = hn::IfThenElseZero(hn::Lt(X[k], cutoff2), sum[k]);
  }
  if (HWY_LIKELY(hn::AllFalse(d, hn::Lt(nearest, core2)))) return;
  for (int k = 0; k < K; ++k) {
    const auto in_core = hn::Lt(X[k], core2);
    const auto rho = hn::Sqrt(hn::Max(X[k], hn::Set(d, static_cast<T>(1e-12) / (t.unit * t.unit))));
    const auto e = hn::Sub(hn::Mul(rho, hn::Set(d, t.unit)), hn::Set(d, t.contact + t.core));
    const auto v1 = hn::Set(d, t.v1), v2 = hn::Set(d, t.v2);
    if constexpr (energies)
      u[k] = hn::IfThenElse(
          in_core, hn::MulAdd(e, hn::MulAdd(hn::Mul(e, hn::Set(d, static_cast<T>(0.5))), v2, v1), hn::Set(d, t.v0)),
          u[k]);
    // du/dy = du/drho unit/(2 rho scale), rho in units.
    const auto of_core =
        hn::Div(hn::Mul(hn::MulAdd(e, v2, v1), hn::Set(d, t.unit)), hn::Mul(rho, hn::Set(d, 2 * t.scale)));
    slope[k] = hn::IfThenElse(in_core, of_core, slope[k]);
  }
}

template <class D>
HWY_INLINE double total(D d, hn::Vec<D> v) {
  return static_cast<double>(hn::GetLane(hn::SumOfLanes(d, v)));
}

#if HWY_TARGET != HWY_SCALAR
// x y z z in every block of four lanes, the blocks' sums those of the lanes: added while they are shuffled
// together.
template <class D, class V>
HWY_INLINE V in_blocks(D d, V x, V y, V z) {
  const hn::Repartition<std::uint64_t, D> pairs;
  const auto xy = hn::Add(hn::InterleaveLower(d, x, y), hn::InterleaveUpper(d, x, y));  // x02 y02 x13 y13
  const auto zz = hn::Add(hn::InterleaveLower(d, z, z), hn::InterleaveUpper(d, z, z));
  const auto low = hn::InterleaveLower(pairs, hn::BitCast(pairs, xy), hn::BitCast(pairs, zz));
  const auto high = hn::InterleaveUpper(pairs, hn::BitCast(pairs, xy), hn::BitCast(pairs, zz));
  return hn::Add(hn::BitCast(d, low), hn::BitCast(d, high));
}
#endif

// The sums of the lanes of six vectors, force and moment.
template <class V>
HWY_INLINE void totals(V fx, V fy, V fz, V mx, V my, V mz, double (&f)[3], double (&m)[3]) {
  const hn::DFromV<V> d;
#if HWY_TARGET != HWY_SCALAR
  constexpr std::size_t lanes = hn::MaxLanes(d), half = lanes / 2;
  if constexpr (sizeof(hn::TFromD<decltype(d)>) == 4 && lanes >= 8) {
    const V force = in_blocks(d, fx, fy, fz), moment = in_blocks(d, mx, my, mz);
    V sums = hn::Add(hn::ConcatLowerLower(d, moment, force), hn::ConcatUpperUpper(d, moment, force));
    if constexpr (lanes == 16) sums = hn::Add(sums, hn::SwapAdjacentBlocks(sums));
    alignas(64) float all[lanes];
    hn::Store(sums, d, all);
    for (std::size_t a = 0; a < 3; ++a) {
      f[a] = static_cast<double>(all[a]);
      m[a] = static_cast<double>(all[half + a]);
    }
    return;
  }
#endif
  f[0] = total(d, fx), f[1] = total(d, fy), f[2] = total(d, fz);
  m[0] = total(d, mx), m[1] = total(d, my), m[2] = total(d, mz);
}

template <class D>
HWY_INLINE std::uint64_t bits_of(D d, hn::Mask<D> mask) {
#if HWY_TARGET <= HWY_AVX3
  (void)d;
  return mask.raw;
#else
  std::uint8_t bits[8];
  hn::StoreMaskBits(d, mask, bits);
  return bits[0];
#endif
}

// What one element meets. N is the number of its nodes where the compiler knows it, or 0.
template <bool energies, int N, class In>
struct ElementContact {
  using Table = typename In::Table;
  using T = typename Table::Value;
  using L = Lanes<T>;
  using D = typename L::D;
  using V = hn::Vec<D>;
  static constexpr int lanes = static_cast<int>(hn::MaxLanes(D()));
  // Nodes of the element whose polynomials are evaluated at once: as many as the registers hold.
  static constexpr int at_once = N == 0 ? 2 : HWY_TARGET <= HWY_AVX3 ? std::min(N, 6) : (N + 1) / ((N + 2) / 3);

  const In& in;
  typename In::Coordinate centre[3];
  V n[3];                 // its axis
  V force[3], moment[3];  // sums over the nodes of the neighbours, lane by lane
  V energy;

  HWY_INLINE ElementContact(const In& input, std::size_t element) : in(input) {
    const D d;
    const Vec3Array &x = in.state->position, &axis = *in.axis;
    const double position[3] = {x.x[element], x.y[element], x.z[element]},
                 along[3] = {axis.x[element], axis.y[element], axis.z[element]};
    for (int a = 0; a < 3; ++a) {
      centre[a] = L::coordinate(position[a] * in.per_unit);
      n[a] = hn::Set(d, static_cast<T>(along[a]));
      force[a] = moment[a] = hn::Zero(d);
    }
    energy = hn::Zero(d);
  }

  // One vector of nodes: separations, their squares, and their parts along the axis.
  struct Nodes {
    V separation[3], square, along;
  };
  HWY_INLINE Nodes nodes_at(int first) const {
    const auto at = static_cast<std::size_t>(first);
    const V x = L::difference(in.nodes->x.data() + at, centre[0]),
            y = L::difference(in.nodes->y.data() + at, centre[1]),
            z = L::difference(in.nodes->z.data() + at, centre[2]);
    return {{x, y, z},
            hn::MulAdd(x, x, hn::MulAdd(y, y, hn::Mul(z, z))),
            hn::MulAdd(n[0], x, hn::MulAdd(n[1], y, hn::Mul(n[2], z)))};
  }
  // Those within the cutoff of the element's axis between its first and its last node.
  HWY_INLINE std::uint64_t near(const Nodes& nodes, int count, const PairTables<Table>& pair) const {
    const D d;
    const V ahead = hn::Max(hn::Sub(hn::Abs(nodes.along), hn::Set(d, pair.half)), hn::Zero(d));
    const V least = hn::MulAdd(ahead, ahead, hn::NegMulAdd(nodes.along, nodes.along, nodes.square));
    return bits_of(
        d, hn::And(hn::Lt(least, hn::Set(d, pair.table.cutoff2)), hn::FirstN(d, static_cast<std::size_t>(count))));
  }

  // Sums over nodes of the element: A and B, and the energy.
  struct NodeSums {
    V A[2], B[2], u;
  };
  // K nodes, from s on. Two sums of each, as one addition waits for the last one.
  template <int K>
  HWY_INLINE void add_nodes(const Table& table, const T* s, V square, V twice_along, NodeSums& sums) {
    const D d;
    V X[K], u[K], slope[K];
    for (int k = 0; k < K; ++k) {
      const V sk = hn::Set(d, s[k]);
      X[k] = hn::MulAdd(sk, hn::Sub(sk, twice_along), square);
    }
    radial<energies>(d, table, X, u, slope);
    for (int k = 0; k < K; ++k) {
      sums.A[k % 2] = hn::Add(sums.A[k % 2], slope[k]);
      sums.B[k % 2] = hn::MulAdd(hn::Set(d, s[k]), slope[k], sums.B[k % 2]);
      if constexpr (energies) sums.u = hn::Add(sums.u, u[k]);
    }
  }
  HWY_INLINE void add_nodes_of_element(const PairTables<Table>& pair, V square, V twice_along, NodeSums& sums) {
    const T* s = pair.s.data();
    const int nodes = N > 0 ? N : static_cast<int>(pair.s.size());
    int k = 0;
    for (; k + at_once <= nodes; k += at_once) add_nodes<at_once>(pair.table, s + k, square, twice_along, sums);
    constexpr int last = N % at_once;
    if constexpr (N == 0) {
      if (k < nodes) add_nodes<1>(pair.table, s + k, square, twice_along, sums);
    } else if constexpr (last > 0) {
      add_nodes<last>(pair.table, s + k, square, twice_along, sums);
    }
  }

  // Keeps the vectors of nodes of a span of which some are in reach. The sums over them come later: so the many
  // operations of one vector that wait for each other overlap with those of the next.
  HWY_INLINE void find(int first, int count, const PairTables<Table>& pair, NodeVectors<T>& found) const {
    const D d;
    for (const int end = first + count; first < end; first += lanes) {
      Nodes nodes = nodes_at(first);
      const std::uint64_t bits = near(nodes, end - first, pair);
      if (bits == 0) continue;
      const int skip = static_cast<int>(hwy::Num0BitsBelowLS1Bit_Nonzero64(bits));
      if ((end - first - 1) / lanes > (end - first - skip - 1) / lanes) {  // spares the last vector
        first += skip;
        nodes = nodes_at(first);
      }
      T* const to = found.add(first, lanes);
      for (int a = 0; a < 3; ++a) hn::Store(nodes.separation[a], d, to + a * lanes);
      // Lanes of no node of this span are put out of reach.
      const auto own = hn::FirstN(d, static_cast<std::size_t>(end - first));
      hn::Store(hn::IfThenElse(own, nodes.square, hn::Set(d, pair.far2)), d, to + 3 * lanes);
      hn::Store(hn::Add(nodes.along, nodes.along), d, to + 4 * lanes);
    }
  }

  HWY_INLINE void sum(const NodeVectors<T>& found, const PairTables<Table>& pair, NodeForces<T>& forces) {
    const D d;
    const V zero = hn::Zero(d), weight = hn::Set(d, pair.weight);
    for (int v = 0; v < found.count; ++v) {
      const T* const nodes = found.at(v, lanes);
      NodeSums sums{{zero, zero}, {zero, zero}, zero};
      add_nodes_of_element(pair, hn::Load(d, nodes + 3 * lanes), hn::Load(d, nodes + 4 * lanes), sums);
      const V A = hn::Mul(hn::Add(sums.A[0], sums.A[1]), weight),
              B = hn::Mul(hn::Add(sums.B[0], sums.B[1]), weight);
      if constexpr (energies) energy = hn::MulAdd(sums.u, hn::Set(d, pair.energy_weight), energy);
      const auto first = static_cast<std::size_t>(found.first[static_cast<std::size_t>(v)]);
      T* const on[3] = {forces.x.data() + first, forces.y.data() + first, forces.z.data() + first};
      for (int a = 0; a < 3; ++a) {
        const V separation = hn::Load(d, nodes + a * lanes);
        const V f = hn::NegMulAdd(B, n[a], hn::Mul(A, separation));
        hn::StoreU(hn::Add(hn::LoadU(d, on[a]), f), d, on[a]);
        force[a] = hn::Add(force[a], f);
        moment[a] = hn::MulAdd(B, separation, moment[a]);
      }
    }
  }

  HWY_INLINE void give(std::size_t element, std::size_t at, ContactBuffer<T>& out) const {
    double f[3], m[3];
    totals(force[0], force[1], force[2], moment[0], moment[1], moment[2], f, m);
    for (double& a : m) a *= in.unit;
    const double nx = in.axis->x[element], ny = in.axis->y[element], nz = in.axis->z[element];
    out.fx[at] -= static_cast<T>(f[0]);
    out.fy[at] -= static_cast<T>(f[1]);
    out.fz[at] -= static_cast<T>(f[2]);
    out.tx[at] -= static_cast<T>(ny * m[2] - nz * m[1]);
    out.ty[at] -= static_cast<T>(nz * m[0] - nx * m[2]);
    out.tz[at] -= static_cast<T>(nx * m[1] - ny * m[0]);
    if constexpr (energies) out.energy += total(D(), energy);
  }
};

template <bool energies, int N, class In, class T>
HWY_NOINLINE void segment_contact(const In& in, const LineChunk& chunk, const Segment& own, LineWork<T>& work,
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
HWY_INLINE void chunk_contact(const In& in, const LineChunk& chunk, LineWork<T>& work, ContactBuffer<T>& out) {
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

}  // namespace ropewalk::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace ropewalk {

HWY_EXPORT(Mixed);
HWY_EXPORT(Full);

void line_contact(const LineKernelInput<MixedTable, std::int32_t>& in, const LineChunk& chunk,
                  LineWork<float>& work, ContactBuffer<float>& out) {
  HWY_DYNAMIC_DISPATCH(Mixed)(in, chunk, work, out);
}

void line_contact(const LineKernelInput<FullTable, double>& in, const LineChunk& chunk, LineWork<double>& work,
                  ContactBuffer<double>& out) {
  HWY_DYNAMIC_DISPATCH(Full)(in, chunk, work, out);
}

namespace {

// The unit of the other loops, which has what the set has.
VectorUnit unit_beside(const std::string& set) {
  const auto begins = [&](const char* with) { return set.rfind(with, 0) == 0; };
  return begins("AVX3") || begins("AVX10") ? VectorUnit::v4 : begins("AVX2") ? VectorUnit::v3 : VectorUnit::base;
}

}  // namespace

std::vector<std::string> instruction_sets() {
  std::vector<std::string> names;
  for (auto left = hwy::SupportedTargets() & HWY_TARGETS; left != 0; left &= left - 1)
    names.emplace_back(hwy::TargetName(left & -left));
  return names;
}

bool use_instructions(const std::string& name) {
  hwy::SetSupportedTargetsForTest(0);
  auto chosen = name.empty() ? hwy::SupportedTargets() : decltype(hwy::SupportedTargets()){0};
  for (auto left = hwy::SupportedTargets() & HWY_TARGETS; left != 0 && chosen == 0; left &= left - 1)
    if (hwy::TargetName(left & -left) == name) chosen = left & -left;
  if (chosen == 0) return false;
  hwy::SetSupportedTargetsForTest(name.empty() ? 0 : chosen);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  vector_unit_in_use = unit_beside(instructions_in_use());
  return true;
}

}  // namespace ropewalk
#endif  // HWY_ONCE
