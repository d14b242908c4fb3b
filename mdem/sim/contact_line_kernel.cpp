// The line law over rows of nodes, for every instruction set that the compiler knows and in two precisions; the
// machine's best is picked at run time. The arithmetic of the law is in the tables (radial_table.hpp).
#include "sim/line_engine.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sim/contact_line_kernel.cpp"
#include <hwy/foreach_target.h>
//
#include <hwy/highway.h>
//
#include "sim/some_lanes-inl.hpp"

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
#if HWY_TARGET <= HWY_AVX3
  if constexpr (sizeof(T) == 4 && segments == 16)
    return hn::Vec<D>{_mm512_permutexvar_ps(index.raw, hn::Load(d, row).raw)};
#elif HWY_TARGET == HWY_AVX2
  if constexpr (sizeof(T) == 4 && segments == 16) {
    const __m256 low = _mm256_permutevar8x32_ps(hn::Load(d, row).raw, index.raw),
                 high = _mm256_permutevar8x32_ps(hn::Load(d, row + 8).raw, index.raw);
    return hn::Vec<D>{_mm256_blendv_ps(low, high, _mm256_castsi256_ps(hn::ShiftLeft<28>(index).raw))};
  }
#endif
  const hn::RebindToSigned<D> di;
  return hn::GatherIndex(d, row, hn::And(index, hn::Set(di, segments - 1)));
}

// u, if wanted, and du/dy at squared distances X; zero beyond the cutoff and outside of `wanted`.
template <bool energies, class D, class Table>
HWY_INLINE void radial(D d, const Table& t, hn::Vec<D> X, hn::Mask<D> wanted, hn::Vec<D>& u, hn::Vec<D>& slope) {
  using T = typename Table::Value;
  const hn::RebindToSigned<D> di;
  const auto y = hn::MulAdd(X, hn::Set(d, t.scale), hn::Set(d, t.shift));
  const auto index = hn::ShiftRight<Table::mantissa_left>(hn::BitCast(di, y));
  const auto start = hn::BitCast(d, hn::ShiftLeft<Table::mantissa_left>(index));
  const auto s = hn::Sub(y, start);
  auto dp = look_up(d, t.d[Table::degree - 1], index);
  for (int k = Table::degree - 2; k >= 0; --k) dp = hn::MulAdd(dp, s, look_up(d, t.d[k], index));
  auto p = hn::Zero(d);
  if constexpr (energies) {
    p = look_up(d, t.c[Table::degree], index);
    for (int k = Table::degree - 1; k >= 0; --k) p = hn::MulAdd(p, s, look_up(d, t.c[k], index));
  }
  const auto core = hn::Lt(X, hn::Set(d, t.core2));
  if (HWY_UNLIKELY(!hn::AllFalse(d, core))) {
    const auto rho = hn::Sqrt(hn::Max(X, hn::Set(d, static_cast<T>(1e-12) / (t.unit * t.unit))));
    const auto e = hn::Sub(hn::Mul(rho, hn::Set(d, t.unit)), hn::Set(d, t.contact + t.core));
    const auto v1 = hn::Set(d, t.v1), v2 = hn::Set(d, t.v2);
    const auto inner =
        hn::MulAdd(e, hn::MulAdd(hn::Mul(e, hn::Set(d, static_cast<T>(0.5))), v2, v1), hn::Set(d, t.v0));
    // du/dy = du/drho unit/(2 rho scale), rho in units.
    const auto inner_slope =
        hn::Div(hn::Mul(hn::MulAdd(e, v2, v1), hn::Set(d, t.unit)), hn::Mul(rho, hn::Set(d, 2 * t.scale)));
    p = hn::IfThenElse(core, inner, p);
    dp = hn::IfThenElse(core, inner_slope, dp);
  }
  const auto near = hn::And(wanted, hn::Lt(X, hn::Set(d, t.cutoff2)));
  if constexpr (energies) u = hn::IfThenElseZero(near, p);
  slope = hn::IfThenElseZero(near, dp);
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
  const typename L::D d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const auto kf = hn::Set(d, t.force * factor);
  auto energy = hn::Zero(d);
  const C *x = nodes.x.data() + row.begin, *y = nodes.y.data() + row.begin, *z = nodes.z.data() + row.begin;
  T *ox = out.x.data() + row.at, *oy = out.y.data() + row.at, *oz = out.z.data() + row.at;
  for (int m = 0; m < row.count; m += lanes) {
    auto gx = hn::LoadU(d, ox + m), gy = hn::LoadU(d, oy + m), gz = hn::LoadU(d, oz + m);
    const auto wanted = hn::FirstN(d, static_cast<std::size_t>(row.count - m));
    const auto x0 = L::difference(x + m, from[0][0]), y0 = L::difference(y + m, from[0][1]),
               z0 = L::difference(z + m, from[0][2]);
    for (int k = 0; k < K; ++k) {
      // The nodes of one element are so close that their difference is exact in T.
      const auto apart = [&](int a) { return hn::Set(d, static_cast<T>(from[k][a] - from[0][a])); };
      const auto dx = k == 0 ? x0 : hn::Sub(x0, apart(0));
      const auto dy = k == 0 ? y0 : hn::Sub(y0, apart(1));
      const auto dz = k == 0 ? z0 : hn::Sub(z0, apart(2));
      hn::Vec<typename L::D> u, slope;
      radial<energies>(d, t, hn::MulAdd(dx, dx, hn::MulAdd(dy, dy, hn::Mul(dz, dz))), wanted, u, slope);
      const auto f = hn::Mul(slope, kf);
      if constexpr (energies) energy = hn::Add(energy, u);
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
    alignas(64) float all[lanes];
    hn::Store(hn::Add(hn::ConcatLowerLower(d, moment, force), hn::ConcatUpperUpper(d, moment, force)), d, all);
    for (std::size_t a = 0; a < 3; ++a) {
      float on = all[a], about = all[half + a];
      for (std::size_t k = 4; k < half; k += 4) on += all[k + a], about += all[half + k + a];
      f[a] = static_cast<double>(on);
      m[a] = static_cast<double>(about);
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
  ContactBuffer& out;
  std::size_t row_of_types;  // of its type in the tables of pairs of types
  TubeEnds ends;
  double x[3], n[3];
  // Forces on its nodes, and these times their places along it; lanes are added up at the end.
  V fx, fy, fz, mx, my, mz, energy;
  ElementSum sum;  // what does not come from nodes

  const PairSum<Real>& sums(int type_j) const { return in.pairs[pair(type_j)]; }
  std::size_t pair(int type_j) const { return row_of_types + static_cast<std::size_t>(type_j); }
  const LineContact& law(int type_j) const { return in.interaction->line[pair(type_j)]; }
  const Table& table(int type_j) const { return in.tables[pair(type_j)]; }
  Rows rows_of(int t) const { return in.rows[t]; }
  const TouchedTube& touched(const LineRun& run) const {
    return chunk.touched[static_cast<std::size_t>(run.touched)];
  }

  HWY_INLINE Element(const In& input, const LineChunk& c, LineWork<Real>& w, ContactBuffer& o, int i, int tube)
      : in(input), chunk(c), work(w), out(o) {
    const Topology& topology = *in.topology;
    row_of_types =
        static_cast<std::size_t>(topology.tube_type[static_cast<std::size_t>(tube)]) * topology.types.size();
    ends = topology.ends_of(i, tube);
    const auto at = static_cast<std::size_t>(i);
    const Vec3Array &place = in.state->position, &axis = *in.axis;
    x[0] = place.x[at], x[1] = place.y[at], x[2] = place.z[at];
    n[0] = axis.x[at], n[1] = axis.y[at], n[2] = axis.z[at];
    fx = fy = fz = mx = my = mz = energy = hn::Zero(D());
  }
  // The couple g n_i x n_j on element j, and its opposite on this one.
  HWY_INLINE void turn(int j, int shift, double g) {
    const Vec3Array& axis = *in.axis;
    const auto sj = static_cast<std::size_t>(j), at = static_cast<std::size_t>(j + shift);
    const double tx = g * (n[1] * axis.z[sj] - n[2] * axis.y[sj]), ty = g * (n[2] * axis.x[sj] - n[0] * axis.z[sj]),
                 tz = g * (n[0] * axis.y[sj] - n[1] * axis.x[sj]);
    sum.tx -= tx, sum.ty -= ty, sum.tz -= tz;
    out.tx[at] += tx, out.ty[at] += ty, out.tz[at] += tz;
  }
  template <bool energies>
  HWY_INLINE void add_to(ContactBuffer& buffer, int at) {
    double f[3], m[3];
    totals(fx, fy, fz, mx, my, mz, f, m);
    sum.fx += f[0];
    sum.fy += f[1];
    sum.fz += f[2];
    sum.tx += n[1] * m[2] - n[2] * m[1];
    sum.ty += n[2] * m[0] - n[0] * m[2];
    sum.tz += n[0] * m[1] - n[1] * m[0];
    if constexpr (energies) sum.energy += total(D(), energy);
    sum.add_to(buffer, at);
  }
};

// K of the nodes of an element, and their sums.
template <class E, int K>
struct Nodes {
  using D = typename E::D;
  typename E::C at[K][3];
  double s[K];
  Sums<D, K> sums;

  HWY_INLINE Nodes(const E& e, const double* places) : sums(no_sums<D, K>(D())) {
    for (int m = 0; m < K; ++m) {
      s[m] = places[m];
      for (int a = 0; a < 3; ++a) at[m][a] = e.in.nodes[0].coordinate(e.x[a] + s[m] * e.n[a]);
    }
  }
  HWY_INLINE void collect(E& e) const {
    for (int k = 0; k < K; ++k) {
      const auto arm = hn::Set(D(), static_cast<typename E::Real>(s[k]));
      e.fx = hn::Add(e.fx, sums.x[k]);
      e.fy = hn::Add(e.fy, sums.y[k]);
      e.fz = hn::Add(e.fz, sums.z[k]);
      e.mx = hn::MulAdd(arm, sums.x[k], e.mx);
      e.my = hn::MulAdd(arm, sums.y[k], e.my);
      e.mz = hn::MulAdd(arm, sums.z[k], e.mz);
    }
    e.energy = hn::Add(e.energy, sums.energy);
  }
};

// K nodes of sum t on an element, from node k, with all rows that it meets.
template <bool energies, int K, class E>
HWY_INLINE void meet_rows(E& e, int t, int k) {
  const MetRows& met = e.work.met[t];
  const Rows kind = e.rows_of(t);
  const auto& placed = e.in.nodes[static_cast<int>(kind)];
  auto& forces = e.work.forces[static_cast<int>(kind)];
  Nodes<E, K> nodes(e, e.sums(met.begin()->type).sums[t].places.data() + k);
  for (const NodeRow& row : met) {
    forces.use(e.chunk, kind, row.touched);
    meet_row<energies, K>(e.table(row.type), placed, forces, row, nodes.at,
                          static_cast<typename E::Real>(e.sums(row.type).sums[t].weight), nodes.sums);
  }
  nodes.collect(e);
}

// The rows of sum t. On its own: within the loop over the elements the compiler keeps more in registers than there
// are.
template <bool energies, class E>
HWY_NOINLINE void sum_rows(E& e, int t) {
  const int on_i = static_cast<int>(e.sums(e.work.met[t].begin()->type).sums[t].places.size());
  int k = 0;
  for (; k + 2 <= on_i; k += 2) meet_rows<energies, 2>(e, t, k);
  for (; k < on_i; ++k) meet_rows<energies, 1>(e, t, k);
}

// Another element, from the one that the loop stands at, and what acts on it.
template <class E>
struct Partner {
  using V = typename E::V;
  double n[3];
  typename E::Real d[3], nj[3], ni[3];  // separation and axes, in units of the list
  V fx, fy, fz, mx, my, mz;

  HWY_INLINE Partner(const E& e, int j) {
    const auto sj = static_cast<std::size_t>(j);
    const Vec3Array &x = e.in.state->position, &axis = *e.in.axis;
    const double per_unit = e.in.nodes[0].per_unit;
    const double place[3] = {x.x[sj], x.y[sj], x.z[sj]};
    n[0] = axis.x[sj], n[1] = axis.y[sj], n[2] = axis.z[sj];
    for (int a = 0; a < 3; ++a) {
      d[a] = static_cast<typename E::Real>((place[a] - e.x[a]) * per_unit);
      nj[a] = static_cast<typename E::Real>(n[a] * per_unit);
      ni[a] = static_cast<typename E::Real>(e.n[a] * per_unit);
    }
    fx = fy = fz = mx = my = mz = hn::Zero(typename E::D());
  }

  HWY_INLINE double cosine(const E& e) const { return e.n[0] * n[0] + e.n[1] * n[1] + e.n[2] * n[2]; }

  // The pairs of nodes in `lanes`, times `share`. Returns their energy, if wanted, without the share.
  template <bool energies>
  HWY_INLINE double meet(E& e, const typename E::Table& t, const PairLanes<typename E::Real>& lanes, double share) {
    const typename E::D tag;
    const auto all = hn::FirstN(tag, hn::Lanes(tag));
    const auto kf = hn::Set(tag, t.force * static_cast<typename E::Real>(share));
    const V none = hn::Zero(tag);
    V gx = none, gy = none, gz = none, tx = none, ty = none, tz = none, ex = none, ey = none, ez = none,
      energy = none;
    for (std::size_t m = 0; m < lanes.weight.size(); m += hn::Lanes(tag)) {
      const V si = hn::LoadU(tag, lanes.i.data() + m), sj = hn::LoadU(tag, lanes.j.data() + m);
      const V w = hn::LoadU(tag, lanes.weight.data() + m);
      const auto apart = [&](int a) {
        return hn::NegMulAdd(si, hn::Set(tag, ni[a]), hn::MulAdd(sj, hn::Set(tag, nj[a]), hn::Set(tag, d[a])));
      };
      const V dx = apart(0), dy = apart(1), dz = apart(2);
      V u, slope;
      radial<energies>(tag, t, hn::MulAdd(dx, dx, hn::MulAdd(dy, dy, hn::Mul(dz, dz))), all, u, slope);
      const V f = hn::Mul(hn::Mul(slope, kf), w);
      const V hx = hn::Mul(f, dx), hy = hn::Mul(f, dy), hz = hn::Mul(f, dz);
      gx = hn::Add(gx, hx), gy = hn::Add(gy, hy), gz = hn::Add(gz, hz);
      tx = hn::MulAdd(sj, hx, tx), ty = hn::MulAdd(sj, hy, ty), tz = hn::MulAdd(sj, hz, tz);
      ex = hn::MulAdd(si, hx, ex), ey = hn::MulAdd(si, hy, ey), ez = hn::MulAdd(si, hz, ez);
      if constexpr (energies) energy = hn::MulAdd(w, u, energy);
    }
    fx = hn::Add(fx, gx), fy = hn::Add(fy, gy), fz = hn::Add(fz, gz);
    mx = hn::Add(mx, tx), my = hn::Add(my, ty), mz = hn::Add(mz, tz);
    e.fx = hn::Sub(e.fx, gx), e.fy = hn::Sub(e.fy, gy), e.fz = hn::Sub(e.fz, gz);
    e.mx = hn::Sub(e.mx, ex), e.my = hn::Sub(e.my, ey), e.mz = hn::Sub(e.mz, ez);
    if constexpr (!energies) return 0;
    return total(tag, energy);
  }

  HWY_INLINE void add_to(ContactBuffer& out, std::size_t at) const {
    double f[3], m[3];
    totals(fx, fy, fz, mx, my, mz, f, m);
    out.fx[at] += f[0];
    out.fy[at] += f[1];
    out.fz[at] += f[2];
    out.tx[at] += n[1] * m[2] - n[2] * m[1];
    out.ty[at] += n[2] * m[0] - n[0] * m[2];
    out.tz[at] += n[0] * m[1] - n[1] * m[0];
  }
};

// Element j, with the shares w of its sums.
template <bool energies, class E>
HWY_INLINE void meet_element(E& e, const LineRun& run, int j, const SumShare& w, Partner<E>& other) {
  const auto& table = e.table(run.type);
  const PairSum<typename E::Real>& sums = e.sums(run.type);
  const TubeEnds ends = run.tube_ends();
  const int shift = e.touched(run).element_shift;
  const auto& lanes = sums.pairs(w.first, e.ends, ends);
  if (w.value >= 1) {
    e.sum.energy += other.template meet<energies>(e, table, lanes, 1);
  } else {
    const double near = other.template meet<true>(e, table, lanes, w.value);
    const double next = other.template meet<true>(e, table, sums.pairs(w.first + 1, e.ends, ends), 1 - w.value);
    e.sum.energy += w.value * near + (1 - w.value) * next;
    // The share depends on the angle: a couple on both.
    e.turn(j, shift, (near - next) * w.derivative);
  }
  other.add_to(e.out, static_cast<std::size_t>(j + shift));
}

// A run element by element: at the ends of tubes.
template <bool energies, class E>
HWY_NOINLINE void pair_run(E& e, const LineRun& run) {
  for (int j = run.element_begin; j < run.element_begin + run.elements; ++j) {
    Partner<E> other(e, j);
    meet_element<energies>(e, run, j, e.law(run.type).sparse.share(other.cosine(e)), other);
  }
}

// The elements m .. end of a run, with `each` nodes, as a row.
HWY_INLINE NodeRow row_of(const LineRun& run, Rows kind, int each, int m, int end) {
  const LineRun::Nodes& nodes = run.of(kind);
  const int from = std::max<int>(nodes.from, m * each), to = std::min(nodes.from + nodes.count, end * each),
            first = from - nodes.from;
  return {nodes.begin + first, nodes.at + first, static_cast<short>(std::max(to - from, 0)), run.type, run.touched};
}

// A run whose angles are such that one sum goes over into the next: rows of those elements that take one sum, and
// the others one by one.
template <bool energies, class E>
HWY_NOINLINE void split_run(E& e, const LineRun& run) {
  const LineContact& law = e.law(run.type);
  int began = 0, of = -1;  // the row that is being made, and its sum
  const auto finish = [&](int end) {
    if (of < 0) return;
    const NodeRow part = row_of(run, e.rows_of(of), law.sum_nodes_j(of), began, end);
    if (part.count > 0) e.work.met[of].add(part);
  };
  for (int m = 0; m < run.elements; ++m) {
    Partner<E> other(e, run.element_begin + m);
    const SumShare w = law.sparse.share(other.cosine(e));
    const int takes = w.value < 1 ? -1 : w.first;
    if (takes != of) {
      finish(m);
      began = m, of = takes;
    }
    if (takes < 0) meet_element<energies>(e, run, run.element_begin + m, w, other);
  }
  finish(run.elements);
}

// run_sum(); of most runs it is known since the list was built that all elements are nearly parallel.
template <class E>
HWY_INLINE RunSum sum_of(const E& e, const LineRun& run) {
  if (HWY_LIKELY(e.in.turned < static_cast<double>(run.even)))
    return {run.fading ? RunSum::pairs : RunSum::rows, 0, 0};
  const LineContact& law = e.law(run.type);
  const bool has_row = e.touched(run).row[0].per_element > 0;
  const hn::CappedTag<double, 8> d;
  const Vec3Array& axis = *e.in.axis;
  const auto nx = hn::Set(d, e.n[0]), ny = hn::Set(d, e.n[1]), nz = hn::Set(d, e.n[2]);
  const auto one = hn::Set(d, 1.0);
  auto largest = hn::Zero(d), smallest = one;
  for (int m = 0; m < run.elements; m += static_cast<int>(hn::Lanes(d))) {
    const int left = std::min(run.elements - m, static_cast<int>(hn::Lanes(d)));
    const auto at = [&](const std::vector<double>& a) {
      return load_some(d, a.data() + run.element_begin + m, 0, left);
    };
    const auto c = hn::MulAdd(nx, at(axis.x), hn::MulAdd(ny, at(axis.y), hn::Mul(nz, at(axis.z))));
    const auto c2 = hn::Mul(c, c);  // of the lanes left over it is zero
    largest = hn::Max(largest, c2);
    smallest = hn::Min(smallest, hn::IfThenElse(some_lanes(d, 0, left), c2, one));
  }
  return run_sum(law, e.ends, run, has_row, hn::GetLane(hn::MinOfLanes(d, smallest)),
                 hn::GetLane(hn::MaxOfLanes(d, largest)));
}

template <bool energies, class In, class Real>
HWY_INLINE void all_elements(const In& in, const LineChunk& chunk, LineWork<Real>& work, ContactBuffer& out) {
  const Topology& topology = *in.topology;
  int tube = chunk.begin < chunk.end ? topology.tube_of(chunk.begin) : 0;
  const int shift = chunk.own_shift();
  for (int i = chunk.begin; i < chunk.end; ++i) {
    while (i >= topology.tube_begin[tube + 1]) ++tube;
    if (in.list->begin(i) == in.list->end(i)) continue;
    Element<In> e(in, chunk, work, out, i, tube);
    for (MetRows& met : work.met) met.count = 0;
    for (const LineRun* run = in.list->begin(i); run != in.list->end(i); ++run) {
      if (static_cast<double>(run->beyond) > in.moved || run->elements == 0) continue;
      const RunSum sum = sum_of(e, *run);
      switch (sum.kind) {
        case RunSum::rows: {
          const LineRun::Nodes& nodes = run->of(e.rows_of(sum.first));
          work.met[sum.first].add({nodes.begin, nodes.at, nodes.count, run->type, run->touched});
          break;
        }
        case RunSum::split:
          split_run<energies>(e, *run);
          break;
        case RunSum::pairs:
          pair_run<energies>(e, *run);
          break;
      }
    }
    for (int t = 0; t < line_sums; ++t)
      if (work.met[t].count > 0) sum_rows<energies>(e, t);
    e.template add_to<energies>(out, i + shift);
  }
}

void Mixed(const LineKernelInput<MixedTable, std::int32_t>& in, const LineChunk& chunk, LineWork<float>& work,
           ContactBuffer& out) {
  in.energies ? all_elements<true>(in, chunk, work, out) : all_elements<false>(in, chunk, work, out);
}

void Full(const LineKernelInput<FullTable, double>& in, const LineChunk& chunk, LineWork<double>& work,
          ContactBuffer& out) {
  in.energies ? all_elements<true>(in, chunk, work, out) : all_elements<false>(in, chunk, work, out);
}

}  // namespace ropewalk::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace ropewalk {

HWY_EXPORT(Mixed);
HWY_EXPORT(Full);

void line_contact(const LineKernelInput<MixedTable, std::int32_t>& in, const LineChunk& chunk,
                  LineWork<float>& work, ContactBuffer& out) {
  HWY_DYNAMIC_DISPATCH(Mixed)(in, chunk, work, out);
}

void line_contact(const LineKernelInput<FullTable, double>& in, const LineChunk& chunk, LineWork<double>& work,
                  ContactBuffer& out) {
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
