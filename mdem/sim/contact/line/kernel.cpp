// The line law over rows of nodes, for every instruction set that the compiler knows and in two precisions; the
// machine's best is picked at run time. The arithmetic of the law is in the tables (radial_table.hpp).
#include <type_traits>

#include "sim/contact/line/engine.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sim/contact/line/kernel.cpp"
#include <hwy/foreach_target.h>
//
#include <hwy/highway.h>
//
#include "sim/threads/lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace ropewalk::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Vectors of a precision. Coordinates of `float` are 32-bit integers, so that differences are exact.
template <class T>
struct Lanes;
template <>
struct Lanes<float> {
  using D = hn::CappedTag<float, 16>;
  static HWY_INLINE hn::Vec<D> difference(const std::int32_t* x, std::int32_t from) {
    const hn::RebindToSigned<D> di;
    return hn::ConvertTo(D(), hn::Sub(hn::LoadU(di, x), hn::Set(di, from)));
  }
};
template <>
struct Lanes<double> {
  using D = hn::CappedTag<double, 8>;
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

// A squared distance X in a polynomial of either form (radial_table.hpp): which one holds there, the place in it,
// and what makes of its slope the force per separation, zero where not `near`. `sum_up` works on K of them at once.
// Beyond the cutoff the slope of a piece is some number, as w is between 0 and its outermost edge, and `near` may
// be in the factor; that of a table's segment may be too large for one.
template <class D>
struct InTable {
  using V = hn::Vec<D>;
  hn::Vec<hn::RebindToSigned<D>> index;
  V s, of_slope;
  hn::Mask<D> near;

  template <class Table>
  static HWY_INLINE const auto& of(const Table& t) {
    return t;
  }
  template <class T, int segments, int degree>
  HWY_INLINE void find(D d, const RadialTable<T, segments, degree>& t, V X, hn::Mask<D> is_near, V factor) {
    constexpr int left = RadialTable<T, segments, degree>::mantissa_left;
    const auto y = hn::MulAdd(X, hn::Set(d, t.scale), hn::Set(d, t.shift));
    index = hn::ShiftRight<left>(hn::BitCast(hn::RebindToSigned<D>(), y));
    s = hn::Sub(y, hn::BitCast(d, hn::ShiftLeft<left>(index)));
    of_slope = factor;
    near = is_near;
  }
  HWY_INLINE V force(V slope) const { return hn::Mul(hn::IfThenElseZero(near, slope), of_slope); }

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
  V s, s2, of_slope;

  static HWY_INLINE const auto& of(const MixedTable& t) { return t.pieces; }
  template <class T, int degree>
  HWY_INLINE void find(D d, const RadialPieces<T, degree>& t, V X, hn::Mask<D> near, V factor) {
    const auto w = hn::Div(hn::Set(d, t.width), hn::Sub(X, hn::Set(d, t.pole)));
    const auto within = [&](int k) {  // -1 or 0
      return hn::BitCast(hn::RebindToSigned<D>(), hn::VecFromMask(d, hn::Lt(X, hn::Set(d, t.edge[k]))));
    };
    index = hn::Add(within(0), hn::Add(within(1), within(2)));
    s = hn::Sub(w, look_up(d, t.middle, index));
    s2 = hn::Mul(s, s);
    of_slope = hn::IfThenElseZero(near, hn::Mul(factor, hn::Mul(w, w)));
  }
  HWY_INLINE V force(V slope) const { return hn::Mul(slope, of_slope); }

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

// Whether this instruction set looks up few entries only, and has 16 registers at most.
constexpr bool narrow = HWY_TARGET > HWY_AVX3;

// The form that costs it less.
template <class Table, class D>
using Form = std::conditional_t<narrow && std::is_same_v<Table, MixedTable>, InPieces<D>, InTable<D>>;

// Of K vectors of squared distances X: du/dy times `by`, for the force per separation, and, if wanted, u; zero from
// the cutoff on.
template <bool energies, int K, class D, class Table>
HWY_INLINE void radial(D d, const Table& t, const hn::Vec<D> (&X)[K], const hn::Vec<D> (&by)[K], hn::Vec<D> (&u)[K],
                       hn::Vec<D> (&force)[K]) {
  using T = typename Table::Value;
  using At = Form<Table, D>;
  const auto& form = At::of(t);
  At at[K];
  auto in_core = hn::Lt(X[0], hn::Set(d, t.core2));
  for (int k = 0; k < K; ++k) {
    at[k].find(d, form, X[k], hn::Lt(X[k], hn::Set(d, t.cutoff2)), by[k]);
    if (k > 0) in_core = hn::Or(in_core, hn::Lt(X[k], hn::Set(d, t.core2)));
  }
  hn::Vec<D> slope[K];
  At::sum_up(d, form.d, at, slope);
  for (int k = 0; k < K; ++k) force[k] = at[k].force(slope[k]);
  if constexpr (energies) {
    At::sum_up(d, form.c, at, u);
    for (int k = 0; k < K; ++k) u[k] = hn::IfThenElseZero(hn::Lt(X[k], hn::Set(d, t.cutoff2)), u[k]);
  }
  if (HWY_LIKELY(hn::AllFalse(d, in_core))) return;
  for (int k = 0; k < K; ++k) {
    const auto core = hn::Lt(X[k], hn::Set(d, t.core2));
    const auto rho = hn::Sqrt(hn::Max(X[k], hn::Set(d, static_cast<T>(1e-12) / (t.unit * t.unit))));
    const auto e = hn::Sub(hn::Mul(rho, hn::Set(d, t.unit)), hn::Set(d, t.contact + t.core));
    const auto v1 = hn::Set(d, t.v1), v2 = hn::Set(d, t.v2);
    if constexpr (energies)
      u[k] = hn::IfThenElse(
          core, hn::MulAdd(e, hn::MulAdd(hn::Mul(e, hn::Set(d, static_cast<T>(0.5))), v2, v1), hn::Set(d, t.v0)),
          u[k]);
    // du/dy = du/drho unit/(2 rho scale), rho in units.
    const auto of_core =
        hn::Div(hn::Mul(hn::MulAdd(e, v2, v1), hn::Set(d, t.unit)), hn::Mul(rho, hn::Set(d, 2 * t.scale)));
    force[k] = hn::IfThenElse(core, hn::Mul(of_core, by[k]), force[k]);
  }
}

// Where a lane is not wanted, a distance out of reach.
template <class D, class Table>
HWY_INLINE hn::Vec<D> only(D d, hn::Mask<D> wanted, hn::Vec<D> X, const Table& t) {
  return hn::IfThenElse(wanted, X, hn::Set(d, t.cutoff2));
}

template <class D, int K>
struct Sums {
  hn::Vec<D> x[K], y[K], z[K], energy;
};

template <class D, int K>
HWY_INLINE Sums<D, K> no_sums(D d) {
  Sums<D, K> s;
  s.energy = hn::Zero(d);
  for (int k = 0; k < K; ++k) s.x[k] = s.y[k] = s.z[k] = hn::Zero(d);
  return s;
}

// The nodes of a row against K nodes of one element.
template <bool energies, int K, class Table, class C>
HWY_INLINE void meet_row(const Table& t, const LineNodes<C>& nodes, NodeForces<typename Table::Value>& out,
                         const NodeRow& row, const C (*from)[3], typename Table::Value factor,
                         Sums<typename Lanes<typename Table::Value>::D, K>& sums) {
  using T = typename Table::Value;
  using L = Lanes<T>;
  using V = hn::Vec<typename L::D>;
  const typename L::D d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const auto kf = hn::Set(d, t.force * factor);
  auto energy = hn::Zero(d);
  const C *x = nodes.x.data() + row.at, *y = nodes.y.data() + row.at, *z = nodes.z.data() + row.at;
  T *ox = out.x.data() + row.at, *oy = out.y.data() + row.at, *oz = out.z.data() + row.at;
  for (int m = 0; m < row.count; m += lanes) {
    const auto wanted = hn::FirstN(d, static_cast<std::size_t>(row.count - m));
    const auto x0 = L::difference(x + m, from[0][0]), y0 = L::difference(y + m, from[0][1]),
               z0 = L::difference(z + m, from[0][2]);
    // Places of the nodes from the first, whose distance has no more digits than those of the row. Twice made is
    // cheaper than kept: there are not registers enough.
    const auto from_node = [&](V first, int k, int a) {
      return k == 0 ? first : hn::Sub(first, hn::Set(d, static_cast<T>(from[k][a] - from[0][a])));
    };
    V X[K], by[K], u[K], force[K];
    for (int k = 0; k < K; ++k) {
      const V dx = from_node(x0, k, 0), dy = from_node(y0, k, 1), dz = from_node(z0, k, 2);
      X[k] = only(d, wanted, hn::MulAdd(dx, dx, hn::MulAdd(dy, dy, hn::Mul(dz, dz))), t);
      by[k] = kf;
    }
    radial<energies>(d, t, X, by, u, force);
    auto gx = hn::LoadU(d, ox + m), gy = hn::LoadU(d, oy + m), gz = hn::LoadU(d, oz + m);
    for (int k = 0; k < K; ++k) {
      const V dx = from_node(x0, k, 0), dy = from_node(y0, k, 1), dz = from_node(z0, k, 2);
      const V f = force[k];
      if constexpr (energies) energy = hn::Add(energy, u[k]);
      gx = hn::MulAdd(f, dx, gx);
      gy = hn::MulAdd(f, dy, gy);
      gz = hn::MulAdd(f, dz, gz);
      sums.x[k] = hn::NegMulAdd(f, dx, sums.x[k]);
      sums.y[k] = hn::NegMulAdd(f, dy, sums.y[k]);
      sums.z[k] = hn::NegMulAdd(f, dz, sums.z[k]);
    }
    hn::StoreU(gx, d, ox + m);
    hn::StoreU(gy, d, oy + m);
    hn::StoreU(gz, d, oz + m);
  }
  if constexpr (energies) sums.energy = hn::MulAdd(energy, hn::Set(d, factor), sums.energy);
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

// The element that the loop stands at.
template <class In>
struct Element {
  using Table = typename In::Table;
  using Real = typename Table::Value;
  using C = typename In::Coordinate;
  using D = typename Lanes<Real>::D;
  using V = hn::Vec<D>;

  const In& in;
  const LineChunk& chunk;
  LineWork<Real>& work;
  ContactBuffer<Real>& out;
  int element, at;           // and its entry in the buffers
  std::size_t row_of_types;  // of its type in the tables of pairs of types
  TubeEnds ends;
  double x[3], n[3];
  ElementSum sum;

  const PairSum<Real>& sums(int type_j) const { return in.pairs[pair(type_j)]; }
  std::size_t pair(int type_j) const { return row_of_types + static_cast<std::size_t>(type_j); }
  const LineContact& law(int type_j) const { return in.interaction->line[pair(type_j)]; }
  const Table& table(int type_j) const { return in.tables[pair(type_j)]; }
  Rows rows_of(int t) const { return in.rows[t]; }
  // Of its nodes in sum t, whatever the partner.
  const std::vector<double>& places(int t) const { return sums(0).sums[t].places; }
  PairKind kind(const LineRun& run, int sum, bool shared) const {
    return {static_cast<int>(pair(run.type)), sum, ends, run.tube_ends(), shared};
  }
  const TouchedPart& part(const LineRun& run) const { return chunk.parts[static_cast<std::size_t>(run.part)]; }

  HWY_INLINE Element(const In& input, const LineChunk& c, LineWork<Real>& w, ContactBuffer<Real>& o, int i,
                     int entry, int tube)
      : in(input), chunk(c), work(w), out(o), element(i), at(entry) {
    const Topology& topology = *in.topology;
    row_of_types =
        static_cast<std::size_t>(topology.tube_type[static_cast<std::size_t>(tube)]) * topology.types.size();
    ends = topology.ends_of(i, tube);
    const auto k = static_cast<std::size_t>(i);
    const Vec3Array &place = in.state->position, &axis = *in.axis;
    x[0] = place.x[k], x[1] = place.y[k], x[2] = place.z[k];
    n[0] = axis.x[k], n[1] = axis.y[k], n[2] = axis.z[k];
  }
  // The sums of the lanes of the forces on its nodes, and of these times their places along it.
  HWY_INLINE void add(V fx, V fy, V fz, V mx, V my, V mz) {
    double f[3], m[3];
    totals(fx, fy, fz, mx, my, mz, f, m);
    sum.fx += f[0];
    sum.fy += f[1];
    sum.fz += f[2];
    sum.tx += n[1] * m[2] - n[2] * m[1];
    sum.ty += n[2] * m[0] - n[0] * m[2];
    sum.tz += n[0] * m[1] - n[1] * m[0];
  }
};

// Forces on the nodes of one element, and these times their places along it, lane by lane.
template <class E>
struct OnElement {
  using V = typename E::V;
  V force[3], moment[3];

  HWY_INLINE OnElement() {
    for (int a = 0; a < 3; ++a) force[a] = moment[a] = hn::Zero(typename E::D());
  }
  template <int K>
  HWY_INLINE void add(const Sums<typename E::D, K>& sums, int k, double place) {
    const V arm = hn::Set(typename E::D(), static_cast<typename E::Real>(place));
    const V f[3] = {sums.x[k], sums.y[k], sums.z[k]};
    for (int a = 0; a < 3; ++a) {
      force[a] = hn::Add(force[a], f[a]);
      moment[a] = hn::MulAdd(arm, f[a], moment[a]);
    }
  }
  HWY_INLINE void give(E& e) const { e.add(force[0], force[1], force[2], moment[0], moment[1], moment[2]); }
};

// Some of the nodes of one element, or of two with as many each, one after the other.
template <class E>
struct ElementNodes {
  static constexpr int room = 8;
  static constexpr int most = 2 * room;
  int first, each;            // of all nodes of the elements; nodes of an element
  double place[most + room];  // nm from the centre
  typename E::C at[3][most + room];

  // `count` of those of the sums that have these places, from node `first_node` on.
  HWY_INLINE ElementNodes(const E* elements, const std::vector<double>& places, int first_node, int count)
      : first(first_node), each(static_cast<int>(places.size())) {
    const hn::CappedTag<double, room> d;
    constexpr int lanes = static_cast<int>(hn::MaxLanes(hn::CappedTag<double, room>()));
    for (int k = 0; k < count;) {
      const E& e = elements[element(k)];
      const int from = first + k - element(k) * each, until = std::min(count, k + each - from);
      for (int m = from; k < until; k += lanes, m += lanes) {
        const auto s = load_some(d, places.data() + m, 0, std::min(each - m, lanes));
        hn::StoreU(s, d, place + k);
        for (int a = 0; a < 3; ++a)
          store(d, hn::MulAdd(s, hn::Set(d, e.n[a]), hn::Set(d, e.x[a])), e.in.nodes[0].per_unit, at[a] + k);
      }
      k = until;
    }
  }
  // That node k is on.
  HWY_INLINE int element(int k) const { return first + k >= each ? 1 : 0; }

 private:
  // A number added that has no place left behind the point: the nearest integer is in the low bits.
  template <class D, class V>
  static HWY_INLINE void store(D d, V v, double per_unit, std::int32_t* to) {
    const hn::RebindToUnsigned<D> bits;
    const hn::Rebind<std::uint32_t, D> low;
    const hn::Rebind<std::int32_t, D> coordinate;
    constexpr double rounds = 6755399441055744;  // 1.5 * 2^52
    const auto number = hn::BitCast(bits, hn::MulAdd(v, hn::Set(d, per_unit), hn::Set(d, rounds)));
    hn::StoreU(hn::BitCast(coordinate, hn::TruncateTo(low, number)), coordinate, to);
  }
  template <class D, class V>
  static HWY_INLINE void store(D d, V v, double, double* to) {
    hn::StoreU(v, d, to);
  }
};

// K nodes, from node k on, with all rows that they meet in the sums first .. last - 1. `met` is that of `first`,
// the others follow.
template <bool energies, int K, class E>
HWY_INLINE void meet_rows(const E& e, const MetRows* met, int first, int last, const ElementNodes<E>& nodes, int k,
                          OnElement<E>* on, typename E::V& energy) {
  Sums<typename E::D, K> sums = no_sums<typename E::D, K>(typename E::D());
  typename E::C at[K][3];
  for (int m = 0; m < K; ++m)
    for (int a = 0; a < 3; ++a) at[m][a] = nodes.at[a][k + m];
  for (int t = first; t < last; ++t) {
    const Rows kind = e.rows_of(t);
    const auto& placed = e.in.nodes[static_cast<int>(kind)];
    auto& forces = e.work.forces[static_cast<int>(kind)];
    for (const NodeRow& row : met[t - first]) {
      forces.use(e.chunk, kind, row.part);
      meet_row<energies, K>(e.table(row.type), placed, forces, row, at,
                            static_cast<typename E::Real>(e.sums(row.type).sums[t].weight), sums);
    }
  }
  if (nodes.element(k + K - 1) == 0) {  // most often; the compiler then knows which one
    for (int m = 0; m < K; ++m) on[0].add(sums, m, nodes.place[k + m]);
  } else {
    for (int m = 0; m < K; ++m) on[nodes.element(k + m)].add(sums, m, nodes.place[k + m]);
  }
  if constexpr (energies) energy = hn::Add(energy, sums.energy);
}

// Nodes of i met at once. Where there are few registers the sums of two do not find room either, but rows are
// looked at half as often with four, and more steps that do not wait for each other are in sight of the processor.
template <class Real>
constexpr int nodes_at_once = narrow&& std::is_same_v<Real, float> ? 4 : 2;

// The rows of these sums, which have the same nodes on i. On its own: within the loop over the elements the
// compiler keeps more in registers than there are.
template <bool energies, class E>
HWY_NOINLINE void sum_rows(E* elements, int count, const MetRows* met, int first, int last) {
  const std::vector<double>& places = elements->places(first);
  const int all = count * static_cast<int>(places.size());
  OnElement<E> on[2];
  auto energy = hn::Zero(typename E::D());
  for (int from = 0; from < all; from += ElementNodes<E>::most) {
    const int here = std::min(all - from, ElementNodes<E>::most);
    const ElementNodes<E> nodes(elements, places, from, here);
    int k = 0;
    constexpr int most = nodes_at_once<typename E::Real>;
    for (; k + most <= here; k += most)
      meet_rows<energies, most>(*elements, met, first, last, nodes, k, on, energy);
    if constexpr (most > 2)
      for (; k + 2 <= here; k += 2) meet_rows<energies, 2>(*elements, met, first, last, nodes, k, on, energy);
    if (k < here) meet_rows<energies, 1>(*elements, met, first, last, nodes, k, on, energy);
  }
  for (int k = 0; k < count; ++k) on[k].give(elements[k]);
  if constexpr (energies) elements->sum.energy += total(typename E::D(), energy);
}

// What acts on the elements of pairs, one pair in each lane: forces on j, and the first moments of those on the
// nodes of i (of the opposite ones) and of j.
template <class D>
struct PairTotals {
  using V = hn::Vec<D>;
  V force[3], moment_i[3], moment_j[3], energy;

  HWY_INLINE PairTotals() {
    for (int a = 0; a < 3; ++a) force[a] = moment_i[a] = moment_j[a] = hn::Zero(D());
    energy = hn::Zero(D());
  }
  HWY_INLINE void scale(V by) {
    for (int a = 0; a < 3; ++a) {
      force[a] = hn::Mul(force[a], by);
      moment_i[a] = hn::Mul(moment_i[a], by);
      moment_j[a] = hn::Mul(moment_j[a], by);
    }
  }
  HWY_INLINE void add(const PairTotals& o) {
    for (int a = 0; a < 3; ++a) {
      force[a] = hn::Add(force[a], o.force[a]);
      moment_i[a] = hn::Add(moment_i[a], o.moment_i[a]);
      moment_j[a] = hn::Add(moment_j[a], o.moment_j[a]);
    }
  }
};

// The lanes of a batch from m on.
template <bool energies, class Table>
struct PairLanes {
  using T = typename Table::Value;
  using D = typename Lanes<T>::D;
  using V = hn::Vec<D>;
  const Table& table;
  V apart[3], axis_i[3], axis_j[3];
  hn::Mask<D> wanted;

  HWY_INLINE PairLanes(const Table& t, const PairBatch<T>& batch, int m) : table(t) {
    const D d;
    for (int a = 0; a < 3; ++a) {
      apart[a] = hn::LoadU(d, batch.apart[a] + m);
      axis_i[a] = hn::LoadU(d, batch.axis_i[a] + m);
      axis_j[a] = hn::LoadU(d, batch.axis_j[a] + m);
    }
    wanted = hn::FirstN(d, static_cast<std::size_t>(batch.count - m));
  }

  // K pairs of nodes, from the one at n.
  template <int K>
  HWY_INLINE void add(const NodePairs<T>& nodes, std::size_t n, PairTotals<D>& sum) const {
    const D d;
    V at[K][3], X[K], by[K], u[K], f[K];
    for (std::size_t k = 0; k < K; ++k) {
      const V si = hn::Set(d, nodes.i[n + k]), sj = hn::Set(d, nodes.j[n + k]);
      for (int a = 0; a < 3; ++a) at[k][a] = hn::NegMulAdd(si, axis_i[a], hn::MulAdd(sj, axis_j[a], apart[a]));
      const V X2 = hn::MulAdd(at[k][0], at[k][0], hn::MulAdd(at[k][1], at[k][1], hn::Mul(at[k][2], at[k][2])));
      X[k] = only(d, wanted, X2, table);
      by[k] = hn::Set(d, table.force * nodes.weight[n + k]);
    }
    radial<energies>(d, table, X, by, u, f);
    for (std::size_t k = 0; k < K; ++k) {
      const V si = hn::Set(d, nodes.i[n + k]), sj = hn::Set(d, nodes.j[n + k]);
      for (int a = 0; a < 3; ++a) {
        const V force = hn::Mul(f[k], at[k][a]);
        sum.force[a] = hn::Add(sum.force[a], force);
        sum.moment_i[a] = hn::MulAdd(si, force, sum.moment_i[a]);
        sum.moment_j[a] = hn::MulAdd(sj, force, sum.moment_j[a]);
      }
      if constexpr (energies) sum.energy = hn::MulAdd(hn::Set(d, nodes.weight[n + k]), u[k], sum.energy);
    }
  }
  HWY_INLINE PairTotals<D> meet(const NodePairs<T>& nodes) const {
    PairTotals<D> sum;
    std::size_t n = 0;
    for (; n + 2 <= nodes.weight.size(); n += 2) add<2>(nodes, n, sum);
    for (; n < nodes.weight.size(); ++n) add<1>(nodes, n, sum);
    return sum;
  }
};

template <class T>
HWY_INLINE void add_to(ContactBuffer<T>& out, int at, T sign, const T (&force)[3], const T (&torque)[3]) {
  const auto k = static_cast<std::size_t>(at);
  out.fx[k] += sign * force[0], out.fy[k] += sign * force[1], out.fz[k] += sign * force[2];
  out.tx[k] += torque[0], out.ty[k] += torque[1], out.tz[k] += torque[2];
}

template <class V>
HWY_INLINE void cross(const V (&a)[3], const V (&b)[3], V (&out)[3]) {
  for (int k = 0; k < 3; ++k) {
    const int l = (k + 1) % 3, m = (k + 2) % 3;
    out[k] = hn::MulSub(a[l], b[m], hn::Mul(a[m], b[l]));
  }
}

// The totals of the lanes from m on, onto the elements. `turn` is what a couple on both comes from, where the share
// of a sum depends on their angle.
template <class In, class T, class D>
HWY_INLINE void give_out(const In& in, const PairBatch<T>& batch, int m, const PairTotals<D>& sum, hn::Vec<D> turn,
                         ContactBuffer<T>& out) {
  using V = hn::Vec<D>;
  constexpr int lanes = static_cast<int>(hn::MaxLanes(D()));
  const D d;
  const V unit = hn::Set(d, static_cast<T>(1 / in.nodes[0].per_unit));
  V ni[3], nj[3], on_i[3], on_j[3];
  for (int a = 0; a < 3; ++a) {
    ni[a] = hn::Mul(hn::LoadU(d, batch.axis_i[a] + m), unit);
    nj[a] = hn::Mul(hn::LoadU(d, batch.axis_j[a] + m), unit);
  }
  cross(sum.moment_i, ni, on_i);
  cross(nj, sum.moment_j, on_j);
  if (batch.kind.shared) {
    V couple[3];
    cross(ni, nj, couple);
    const V by = hn::Mul(turn, hn::LoadU(d, batch.derivative + m));
    for (int a = 0; a < 3; ++a) {
      on_i[a] = hn::NegMulAdd(by, couple[a], on_i[a]);
      on_j[a] = hn::MulAdd(by, couple[a], on_j[a]);
    }
  }
  alignas(64) T all[9][lanes];
  for (int a = 0; a < 3; ++a) {
    hn::Store(sum.force[a], d, all[a]);
    hn::Store(on_i[a], d, all[3 + a]);
    hn::Store(on_j[a], d, all[6 + a]);
  }
  for (int l = 0; l < std::min(lanes, batch.count - m); ++l) {
    const T force[3] = {all[0][l], all[1][l], all[2][l]};
    add_to(out, batch.at_i[m + l], T{-1}, force, {all[3][l], all[4][l], all[5][l]});
    add_to(out, batch.at_j[m + l], T{1}, force, {all[6][l], all[7][l], all[8][l]});
  }
}

template <class In>
HWY_INLINE double cosine(const In& in, int i, int j) {
  const auto si = static_cast<std::size_t>(i), sj = static_cast<std::size_t>(j);
  const Vec3Array& axis = *in.axis;
  return axis.x[si] * axis.x[sj] + axis.y[si] * axis.y[sj] + axis.z[si] * axis.z[sj];
}

// All pairs of a batch, which is empty then.
template <bool energies, class In, class T>
HWY_NOINLINE void meet_pairs(const In& in, PairBatch<T>& batch, ContactBuffer<T>& out) {
  using D = typename Lanes<T>::D;
  const D d;
  const auto& table = in.tables[batch.kind.types];
  const auto nodes = [&](int sum) -> const NodePairs<T>& {
    return in.pairs[batch.kind.types].pairs(sum, batch.kind.ends_i, batch.kind.ends_j);
  };
  for (int m = 0; m < batch.count; m += static_cast<int>(hn::Lanes(d))) {
    if (batch.kind.shared) {
      const PairLanes<true, typename In::Table> lanes(table, batch, m);
      PairTotals<D> near = lanes.meet(nodes(batch.kind.sum)), next = lanes.meet(nodes(batch.kind.sum + 1));
      const auto share = hn::LoadU(d, batch.share + m), rest = hn::Sub(hn::Set(d, T{1}), share);
      if constexpr (energies) out.energy += total(d, hn::MulAdd(share, near.energy, hn::Mul(rest, next.energy)));
      const auto turn = hn::Sub(near.energy, next.energy);
      near.scale(share), next.scale(rest);
      near.add(next);
      give_out(in, batch, m, near, turn, out);
    } else {
      const PairTotals<D> sum =
          PairLanes<energies, typename In::Table>(table, batch, m).meet(nodes(batch.kind.sum));
      if constexpr (energies) out.energy += total(d, sum.energy);
      give_out(in, batch, m, sum, hn::Zero(d), out);
    }
  }
  batch.count = 0;
}

template <class In, class T>
HWY_INLINE void fill_lane(const In& in, int i, int j, int at_i, int at_j, PairBatch<T>& batch) {
  const auto l = static_cast<std::size_t>(batch.count++), si = static_cast<std::size_t>(i),
             sj = static_cast<std::size_t>(j);
  const Vec3Array &x = in.state->position, &n = *in.axis;
  const double per_unit = in.nodes[0].per_unit;
  batch.apart[0][l] = static_cast<T>((x.x[sj] - x.x[si]) * per_unit);
  batch.apart[1][l] = static_cast<T>((x.y[sj] - x.y[si]) * per_unit);
  batch.apart[2][l] = static_cast<T>((x.z[sj] - x.z[si]) * per_unit);
  batch.axis_i[0][l] = static_cast<T>(n.x[si] * per_unit);
  batch.axis_i[1][l] = static_cast<T>(n.y[si] * per_unit);
  batch.axis_i[2][l] = static_cast<T>(n.z[si] * per_unit);
  batch.axis_j[0][l] = static_cast<T>(n.x[sj] * per_unit);
  batch.axis_j[1][l] = static_cast<T>(n.y[sj] * per_unit);
  batch.axis_j[2][l] = static_cast<T>(n.z[sj] * per_unit);
  batch.i[l] = i, batch.j[l] = j, batch.at_i[l] = at_i, batch.at_j[l] = at_j;
}

// The pair of the element that the loop stands at and j, with the shares w of its sums, to the others of its kind.
template <bool energies, class E>
HWY_INLINE void add_pair(E& e, const LineRun& run, int j, const SumShare& w) {
  using T = typename E::Real;
  PairBatch<T>& batch = e.work.batch(e.kind(run, w.first, w.value < 1));
  batch.share[batch.count] = static_cast<T>(w.value);
  batch.derivative[batch.count] = static_cast<T>(w.derivative);
  fill_lane(e.in, e.element, j, e.at, j + e.part(run).element_shift, batch);
  if (batch.count == PairBatch<T>::most) meet_pairs<energies>(e.in, batch, e.out);
}

// Pairs by rising `beyond`.
template <bool energies, class In, class T>
HWY_NOINLINE void meet_alike(const In& in, const AlikePairs& of, LineWork<T>& work, ContactBuffer<T>& out) {
  PairBatch<T>& batch = work.batch(of.kind);
  const SparseNodes& sparse = in.interaction->line[static_cast<std::size_t>(of.kind.types)].sparse;
  for (const AlikePairs::Pair& p : of.pairs) {
    if (!may_be_in_reach(p.beyond, in.moved)) break;
    if (of.kind.shared) {
      const SumShare w = sparse.share(of.kind.sum, cosine(in, p.i, p.j));
      batch.share[batch.count] = static_cast<T>(w.value);
      batch.derivative[batch.count] = static_cast<T>(w.derivative);
    }
    fill_lane(in, p.i, p.j, p.at_i, p.at_j, batch);
    if (batch.count == PairBatch<T>::most) meet_pairs<energies>(in, batch, out);
  }
}

// A run element by element: at the ends of tubes.
template <bool energies, class E>
HWY_NOINLINE void pair_run(E& e, const LineRun& run) {
  for (int j = run.element_begin; j < run.element_begin + run.elements; ++j)
    add_pair<energies>(e, run, j, e.law(run.type).sparse.share(cosine(e.in, e.element, j)));
}

// The elements m .. end of a run, with `each` nodes, as a row; none where all of these are out of reach. `first` is
// the run's first node.
HWY_INLINE void add_row(const LineRun& run, Rows kind, int first, int each, int m, int end, MetRows& met) {
  const LineRun::Nodes& nodes = run.of(kind);
  const int from = std::max<int>(nodes.from, m * each), to = std::min(nodes.from + nodes.count, end * each);
  if (from < to) met.add(run, first + from - nodes.from, to - from);
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

// 64 where there is none.
HWY_INLINE int first_bit(std::uint64_t bits) {
  return bits == 0 ? 64 : static_cast<int>(hwy::Num0BitsBelowLS1Bit_Nonzero64(bits));
}

// Which sums the elements of a run take.
template <class E>
HWY_INLINE void find_sums(const E& e, SplitRun& of) {
  const hn::CappedTag<double, 8> d;
  const LineRun& run = *of.run;
  const int sums = e.law(run.type).sparse.count;
  const ElementReach& reach = e.sums(run.type).reach;
  const SumLimits& limits = e.sums(run.type).limits[e.in.plan == LinePlan::Use::none ? 0 : 1];
  const int ended = run.begins || run.ends || e.ends.any() ? 1 : 0;
  const Vec3Array &place = e.in.state->position, &axis = *e.in.axis;
  const auto nx = hn::Set(d, e.n[0]), ny = hn::Set(d, e.n[1]), nz = hn::Set(d, e.n[2]);
  for (auto& bits : of.sum) bits = 0;
  for (auto& bits : of.shared) bits = 0;
  for (int m = 0; m < run.elements; m += static_cast<int>(hn::Lanes(d))) {
    const int left = std::min(run.elements - m, static_cast<int>(hn::Lanes(d)));
    const auto at = [&](const std::vector<double>& a) {
      return load_some(d, a.data() + run.element_begin + m, 0, left);
    };
    const auto mx = at(axis.x), my = at(axis.y), mz = at(axis.z);
    const auto x = hn::Sub(at(place.x), hn::Set(d, e.x[0])), y = hn::Sub(at(place.y), hn::Set(d, e.x[1])),
               z = hn::Sub(at(place.z), hn::Set(d, e.x[2]));
    const auto c = hn::MulAdd(nx, mx, hn::MulAdd(ny, my, hn::Mul(nz, mz))), c2 = hn::Mul(c, c);
    const auto along = hn::MulAdd(nx, x, hn::MulAdd(ny, y, hn::Mul(nz, z)));
    const auto p2 = hn::NegMulAdd(along, along, hn::MulAdd(x, x, hn::MulAdd(y, y, hn::Mul(z, z))));
    const auto q = hn::NegMulAdd(along, c, hn::MulAdd(mx, x, hn::MulAdd(my, y, hn::Mul(mz, z))));
    const auto near = [&](int t) {  // ElementReach::near
      const auto from = hn::Max(hn::Sub(hn::Abs(along), hn::Set(d, reach.ahead[ended][t])), hn::Zero(d));
      const auto least = hn::NegMulAdd(hn::Set(d, reach.beside[ended][t]), hn::Abs(q), hn::MulAdd(from, from, p2));
      return bits_of(d, hn::Lt(least, hn::Set(d, limits.cutoff2)));
    };
    std::uint64_t rest = (std::uint64_t{1} << left) - 1, in_reach = near(0);
    // There is always a second sum, and seldom more.
    for (int t = 0; t < sums && (t < 2 || HWY_UNLIKELY(rest != 0)); ++t) {
      const std::uint64_t takes = rest & bits_of(d, hn::Gt(c2, hn::Set(d, limits.from_cos2[t]))),
                          alone = takes & bits_of(d, hn::Ge(c2, hn::Set(d, limits.full_cos2[t]))),
                          next = near(t + 1);
      of.sum[t] |= (alone & in_reach) << m;
      of.shared[t] |= (takes & ~alone & next) << m;
      rest &= ~takes;
      in_reach = next;
    }
    of.sum[sums] |= (rest & in_reach) << m;
  }
}

// A run whose elements may take several sums: rows of those that take the same one; `pair` takes the others, and
// of which sum they have a share at the least.
template <class E, class Pair>
HWY_INLINE void split(const E& e, const SplitRun& of, MetRows* met, const Pair& pair) {
  const LineRun& run = *of.run;
  const LineContact& law = e.law(run.type);
  const bool has_row = e.part(run).row[static_cast<int>(Rows::all)].per_element > 0;
  const auto pairs = [&](std::uint64_t left, int t, bool shared) {
    for (; left != 0; left &= left - 1) pair(run, run.element_begin + first_bit(left), t, shared);
  };
  for (int t = 0; t <= law.sparse.count; ++t) {
    if (t < law.sparse.count) pairs(of.shared[t], t, true);
    std::uint64_t left = of.sum[t];
    if (left == 0) continue;
    if (fades(law.sparse, t, e.ends, run) || !(has_row || law.sparse.thins_j(t))) {
      pairs(left, t, false);
      continue;
    }
    const Rows kind = e.rows_of(t);
    const int first = e.part(run).first_node(run, kind), each = law.sum_nodes_j(t);
    while (left != 0) {
      const int from = first_bit(left), to = from + first_bit(~(left >> from));
      add_row(run, kind, first, each, from, to, met[t]);
      left &= to < 64 ? ~std::uint64_t{0} << to : 0;
    }
  }
}

// All that one element has put off. What each run takes is found for all of them before the first is met: the
// processor would wait for it at the branches.
template <class E, class Pair>
HWY_INLINE void split_all(const E& e, SplitRuns& runs, MetRows* met, const Pair& pair) {
  for (int k = 0; k < runs.count; ++k) find_sums(e, runs.run[static_cast<std::size_t>(k)]);
  for (int k = 0; k < runs.count; ++k) split(e, runs.run[static_cast<std::size_t>(k)], met, pair);
}

// For the plan as well, which takes the pairs.
template <class E>
HWY_NOINLINE void record_splits(const E& e, SplitRuns& runs, MetRows* met, ChunkPlan& plan) {
  int before[line_sums];
  for (int t = 0; t < line_sums; ++t) before[t] = met[t].count;
  split_all(e, runs, met, [&](const LineRun& run, int j, int sum, bool shared) {
    of_kind(e.kind(run, sum, shared), plan.pairs)
        .pairs.push_back({e.element, j, e.at, j + e.part(run).element_shift, 0});
  });
  plan.elements.emplace_back();
  for (int t = 0; t < line_sums; ++t) {
    plan.elements.back()[static_cast<std::size_t>(t)] = static_cast<short>(met[t].count - before[t]);
    plan.rows.insert(plan.rows.end(), met[t].begin() + before[t], met[t].end());
  }
}

HWY_INLINE void replay_splits(MetRows* met, ChunkPlan& plan) {
  const ChunkPlan::Element& rows = plan.elements[plan.element++];
  for (int t = 0; t < line_sums; ++t)
    for (int k = 0; k < rows[static_cast<std::size_t>(t)]; ++k) met[t].add(plan.rows[plan.row++]);
}

template <bool energies, class E>
HWY_NOINLINE void meet_splits(E& e, SplitRuns& runs, MetRows* met) {
  if (runs.count == 0) return;
  if (e.in.plan == LinePlan::Use::none)
    split_all(e, runs, met, [&](const LineRun& run, int j, int sum, bool shared) {
      const SumShare all{sum, 1, 0};
      add_pair<energies>(e, run, j, shared ? e.law(run.type).sparse.share(sum, cosine(e.in, e.element, j)) : all);
    });
  else if (e.in.plan == LinePlan::Use::record)
    record_splits(e, runs, met, *e.work.plan);
  else
    replay_splits(met, *e.work.plan);
  runs.count = 0;
}

// A run of one element: `met` takes what it meets by rows, `later` the run if it may take several sums. Of most
// runs in straight ropes and in films it is known since the list was built that they take the first, or the last.
template <bool energies, class E>
HWY_INLINE void meet_run(E& e, const LineRun& run, MetRows* met, SplitRuns& later) {
  if (!may_be_in_reach(run.beyond, e.in.moved)) return;
  const auto add = [&](int sum) {
    const Rows kind = e.rows_of(sum);
    met[sum].add(run, e.part(run).first_node(run, kind), run.of(kind).count);
  };
  if (e.in.turned < static_cast<double>(run.even)) {
    if (!run.fading)
      add(0);
    else if (e.in.plan == LinePlan::Use::none)
      pair_run<energies>(e, run);
    else
      later.add(run);
  } else if (e.in.turned < static_cast<double>(run.crossing)) {
    add(e.law(run.type).sparse.count);
  } else {
    later.add(run);
  }
}

void forget(MetRows (&met)[line_sums]) {
  for (MetRows& rows : met) rows.count = 0;
}

// All that one element has met by itself.
template <bool energies, class E>
HWY_INLINE void sum_met(E& e, const MetRows (&met)[line_sums]) {
  for (int t = 0, next; t < line_sums; t = next) {
    bool any = false;
    for (next = t; next < line_sums && e.places(next).size() == e.places(t).size(); ++next)
      any |= met[next].count > 0;
    if (any) sum_rows<energies>(&e, 1, met + t, t, next);
  }
}

// The runs at the ends of tubes, whatever sums they take.
template <bool energies, class In, class Real>
HWY_NOINLINE void meet_end_runs(const In& in, const LineChunk& chunk, LineWork<Real>& work,
                                ContactBuffer<Real>& out) {
  if (chunk.end_runs.empty()) return;
  const Topology& topology = *in.topology;
  int tube = topology.tube_of(chunk.end_runs.front().element);
  for (auto of = chunk.end_runs.begin(), end = chunk.end_runs.end(); of != end;) {
    while (of->element >= topology.tube_begin[tube + 1]) ++tube;
    forget(work.met[0]);
    Element<In> e(in, chunk, work, out, of->element, of->at, tube);
    for (; of != end && of->element == e.element; ++of)
      meet_run<energies>(e, in.list->run(of->run), work.met[0], work.split[0]);
    meet_splits<energies>(e, work.split[0], work.met[0]);
    sum_met<energies>(e, work.met[0]);
    e.sum.add_to(out, e.at);
  }
}

template <bool energies, class In, class Real>
HWY_INLINE void all_elements(const In& in, const LineChunk& chunk, LineWork<Real>& work, ContactBuffer<Real>& out) {
  const Topology& topology = *in.topology;
  if (in.plan == LinePlan::Use::record) work.plan->clear();
  if (in.plan == LinePlan::Use::replay) work.plan->rewind();
  int tube = chunk.blocks.empty() ? 0 : topology.tube_of(chunk.blocks.front().first);
  for (const LineBlock& block : chunk.blocks) {
    while (block.first >= topology.tube_begin[tube + 1]) ++tube;
    const int second = block.elements - 1;
    Element<In> e[2] = {{in, chunk, work, out, block.first, block.at, tube},
                        {in, chunk, work, out, block.first + second, block.at + second, tube}};
    work.shared.count = 0;
    bool alone = false;  // whether an element has met rows by itself
    const auto of_one = [&](int k) {
      if (!alone)
        for (auto& met : work.met) forget(met);
      alone = true;
      return work.met[k];
    };
    for (const BlockRun *run = chunk.runs.data() + block.begin, *end = chunk.runs.data() + block.end; run != end;
         ++run) {
      if (!may_be_in_reach(run->beyond, in.moved)) continue;
      if (HWY_LIKELY(in.turned < static_cast<double>(run->even))) {
        (run->of == BlockRun::both ? work.shared : of_one(run->of)[0]).add(run->row);
        continue;
      }
      for (int k = 0; k < block.elements; ++k)
        if (run->run[k] != BlockRun::none)
          meet_run<energies>(e[k], in.list->run(run->run[k]), of_one(k), work.split[k]);
    }
    if (work.shared.count > 0) sum_rows<energies>(e, block.elements, &work.shared, 0, 1);
    for (int k = 0; k < block.elements; ++k) {
      if (alone) {
        meet_splits<energies>(e[k], work.split[k], work.met[k]);
        sum_met<energies>(e[k], work.met[k]);
      }
      e[k].sum.add_to(out, e[k].at);
    }
  }
  if (in.turned < static_cast<double>(chunk.even)) {
    for (const AlikePairs& of : chunk.end_pairs) meet_alike<energies>(in, of, work, out);
  } else {
    meet_end_runs<energies>(in, chunk, work, out);
  }
  if (in.plan == LinePlan::Use::record) work.plan->shrink();
  if (in.plan != LinePlan::Use::none)
    for (const AlikePairs& of : work.plan->pairs) meet_alike<energies>(in, of, work, out);
  for (auto& batch : work.batches)
    if (batch.count > 0) meet_pairs<energies>(in, batch, out);
}

void Mixed(const LineKernelInput<MixedTable, std::int32_t>& in, const LineChunk& chunk, LineWork<float>& work,
           ContactBuffer<float>& out) {
  in.energies ? all_elements<true>(in, chunk, work, out) : all_elements<false>(in, chunk, work, out);
}

void Full(const LineKernelInput<FullTable, double>& in, const LineChunk& chunk, LineWork<double>& work,
          ContactBuffer<double>& out) {
  in.energies ? all_elements<true>(in, chunk, work, out) : all_elements<false>(in, chunk, work, out);
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
  return true;
}

}  // namespace ropewalk
#endif  // HWY_ONCE
