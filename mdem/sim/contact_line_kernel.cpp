// The line law over rows of nodes, for every instruction set that the compiler knows and in two precisions; the
// machine's best is picked at run time. The arithmetic of the law is in the tables (radial_table.hpp).
#include "sim/line_engine.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sim/contact_line_kernel.cpp"
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
  if constexpr (sizeof(T) == 4 && segments == 32)
    return hn::Vec<D>{_mm512_permutex2var_ps(hn::Load(d, row).raw, index.raw, hn::Load(d, row + 16).raw)};
#endif
  const hn::RebindToSigned<D> di;
  return hn::GatherIndex(d, row, hn::And(index, hn::Set(di, segments - 1)));
}

// u and du/dy at squared distances X; zero beyond the cutoff and outside of `wanted`.
template <class D, class Table>
HWY_INLINE void radial(D d, const Table& t, hn::Vec<D> X, hn::Mask<D> wanted, hn::Vec<D>& u, hn::Vec<D>& slope) {
  using T = typename Table::Value;
  const hn::RebindToSigned<D> di;
  const auto y = hn::MulAdd(X, hn::Set(d, t.scale), hn::Set(d, t.shift));
  const auto index = hn::ShiftRight<Table::mantissa_left>(hn::BitCast(di, y));
  const auto start = hn::BitCast(d, hn::ShiftLeft<Table::mantissa_left>(index));
  const auto s = hn::Sub(y, start);
  auto p = look_up(d, t.c[Table::degree], index);
  auto dp = p;
  p = hn::MulAdd(p, s, look_up(d, t.c[Table::degree - 1], index));
  for (int k = Table::degree - 2; k >= 0; --k) {
    dp = hn::MulAdd(dp, s, p);
    p = hn::MulAdd(p, s, look_up(d, t.c[k], index));
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
  u = hn::IfThenElseZero(near, p);
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

// Nodes of the neighbours begin .. end against K nodes of one element. `weight` and `energies`, where there are
// any, belong to node `begin` first.
template <int K, bool weighted, class Table, class C>
HWY_INLINE void row(const Table& t, const LineNodes<C>& nodes, NodeForces<typename Table::Value>& out, int begin,
                    int end, const C (*from)[3], typename Table::Value factor, const typename Table::Value* weight,
                    typename Table::Value* energies, Sums<typename Lanes<typename Table::Value>::D, K>& sums) {
  using T = typename Table::Value;
  using L = Lanes<T>;
  const typename L::D d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const auto kf = hn::Set(d, t.force * factor);
  auto energy = hn::Zero(d);
  for (int m = begin; m < end; m += lanes) {
    T *ox = out.x.data() + (m - out.first), *oy = out.y.data() + (m - out.first),
      *oz = out.z.data() + (m - out.first);
    auto gx = hn::LoadU(d, ox), gy = hn::LoadU(d, oy), gz = hn::LoadU(d, oz);
    auto each = hn::Zero(d);
    const auto wanted = hn::FirstN(d, static_cast<std::size_t>(end - m));
    const auto x0 = L::difference(nodes.x.data() + m, from[0][0]);
    const auto y0 = L::difference(nodes.y.data() + m, from[0][1]);
    const auto z0 = L::difference(nodes.z.data() + m, from[0][2]);
    for (int k = 0; k < K; ++k) {
      // The nodes of one element are so close that their difference is exact in T.
      const auto apart = [&](int a) { return hn::Set(d, static_cast<T>(from[k][a] - from[0][a])); };
      const auto dx = k == 0 ? x0 : hn::Sub(x0, apart(0));
      const auto dy = k == 0 ? y0 : hn::Sub(y0, apart(1));
      const auto dz = k == 0 ? z0 : hn::Sub(z0, apart(2));
      hn::Vec<typename L::D> u, slope;
      radial(d, t, hn::MulAdd(dx, dx, hn::MulAdd(dy, dy, hn::Mul(dz, dz))), wanted, u, slope);
      auto f = hn::Mul(slope, kf);
      if constexpr (weighted) f = hn::Mul(f, hn::LoadU(d, weight + (m - begin)));
      each = hn::Add(each, u);
      gx = hn::MulAdd(f, dx, gx);
      gy = hn::MulAdd(f, dy, gy);
      gz = hn::MulAdd(f, dz, gz);
      sums.x[k] = hn::NegMulAdd(f, dx, sums.x[k]);
      sums.y[k] = hn::NegMulAdd(f, dy, sums.y[k]);
      sums.z[k] = hn::NegMulAdd(f, dz, sums.z[k]);
    }
    hn::StoreU(gx, d, ox);
    hn::StoreU(gy, d, oy);
    hn::StoreU(gz, d, oz);
    if constexpr (weighted) {
      if (energies)
        hn::StoreU(hn::MulAdd(each, hn::Set(d, factor), hn::LoadU(d, energies + (m - begin))), d,
                   energies + (m - begin));
      each = hn::Mul(each, hn::LoadU(d, weight + (m - begin)));
    }
    energy = hn::Add(energy, each);
  }
  sums.energy = hn::MulAdd(energy, hn::Set(d, factor), sums.energy);
}

// The element that the loop stands at.
template <class In>
struct Element {
  using Table = typename In::Table;
  using Real = typename Table::Value;
  using C = typename In::Coordinate;
  using D = typename Lanes<Real>::D;

  const In& in;
  NodeForces<Real>& forces;
  ContactBuffer& out;
  int touched_begin;
  std::size_t row_of_types;  // of its type in the tables of pairs of types
  double x[3], n[3];
  // Forces on its nodes, and these times their places along it; lanes are added up at the end.
  hn::Vec<D> fx, fy, fz, mx, my, mz, energy;
  ElementSum sum;  // what does not come from nodes

  const LineContact& law(int type_j) const {
    return in.interaction->line[row_of_types + static_cast<std::size_t>(type_j)];
  }
  const Table& table(int type_j) const { return in.tables[row_of_types + static_cast<std::size_t>(type_j)]; }
  HWY_INLINE void add_to(ContactBuffer& buffer, int i) {
    const auto total = [&](hn::Vec<D> v) { return static_cast<double>(hn::GetLane(hn::SumOfLanes(D(), v))); };
    const double m[3] = {total(mx), total(my), total(mz)};
    sum.fx += total(fx);
    sum.fy += total(fy);
    sum.fz += total(fz);
    sum.tx += n[1] * m[2] - n[2] * m[1];
    sum.ty += n[2] * m[0] - n[0] * m[2];
    sum.tz += n[0] * m[1] - n[1] * m[0];
    sum.energy += total(energy);
    sum.add_to(buffer, i - touched_begin);
  }
};

// The nodes k .. k + K of `on_i` on an element, and their sums.
template <class E, int K>
struct Nodes {
  using D = typename E::D;
  typename E::C at[K][3];
  double s[K];
  Sums<D, K> sums;

  HWY_INLINE Nodes(const E& e, int k, int on_i, double length) : sums(no_sums<D, K>(D())) {
    for (int m = 0; m < K; ++m) {
      s[m] = line_node(k + m, on_i, length);
      for (int a = 0; a < 3; ++a) at[m][a] = e.in.nodes->coordinate(e.x[a] + s[m] * e.n[a]);
    }
  }
  template <bool weighted = false>
  HWY_INLINE void meet(E& e, const LineRun& run, double node_weight, const typename E::Real* weight = nullptr,
                       typename E::Real* energies = nullptr) {
    row<K, weighted>(e.table(run.type), *e.in.nodes, e.forces, run.node_begin, run.node_end, at,
                     static_cast<typename E::Real>(node_weight), weight, energies, sums);
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

HWY_INLINE double node_weight(const LineContact& law, int on_i) {
  return law.length_i / on_i * law.length_j / law.nodes_j;
}

// K of the sparse nodes of an element, with runs of nearly parallel elements.
template <int K, class E>
HWY_INLINE void sparse_runs(E& e, int k, int on_i, const std::vector<const LineRun*>& runs) {
  Nodes<E, K> nodes(e, k, on_i, e.law(runs[0]->type).length_i);
  for (const LineRun* run : runs) nodes.meet(e, *run, node_weight(e.law(run->type), on_i));
  nodes.collect(e);
}

// `on_i` nodes against those of one run, with a weight for each of these or without.
template <bool weighted, class E>
HWY_INLINE void node_sum(E& e, const LineRun& run, int on_i, const typename E::Real* weight = nullptr,
                         typename E::Real* energies = nullptr) {
  const LineContact& law = e.law(run.type);
  const double w = node_weight(law, on_i);
  int k = 0;
  for (; k + 2 <= on_i; k += 2) {
    Nodes<E, 2> nodes(e, k, on_i, law.length_i);
    nodes.template meet<weighted>(e, run, w, weight, energies);
    nodes.collect(e);
  }
  for (; k < on_i; ++k) {
    Nodes<E, 1> nodes(e, k, on_i, law.length_i);
    nodes.template meet<weighted>(e, run, w, weight, energies);
    nodes.collect(e);
  }
}

template <class E>
HWY_NOINLINE void dense_run(E& e, const LineRun& run) {
  node_sum<false>(e, run, e.law(run.type).nodes_i);
}

// The first or last element of a tube, nearly parallel: the shares of its nodes are those of the ramp alone.
template <class E>
HWY_NOINLINE void end_run(E& e, const LineRun& run, LineScratch<typename E::Real>& w) {
  using Real = typename E::Real;
  const LineContact& law = e.law(run.type);
  const int nodes = law.nodes_j, skipped = run.node_begin - run.row;
  const auto most = static_cast<std::size_t>(nodes + 2 * NodeLayout::pad);
  if (w.sparse.size() < most)
    for (auto* v : {&w.sparse, &w.dense}) v->resize(most, Real{0});
  for (int l = skipped; l < nodes; ++l) {
    const double share = end_ramp(l, nodes, run.begins, run.ends);
    w.sparse[static_cast<std::size_t>(l - skipped)] = static_cast<Real>(share);
    w.dense[static_cast<std::size_t>(l - skipped)] = static_cast<Real>(1 - share);
  }
  node_sum<true>(e, run, law.sparse_i, w.sparse.data());
  node_sum<true>(e, run, law.nodes_i, w.dense.data());
}

// A run whose elements do not all take the same sum.
template <class E>
HWY_NOINLINE void mixed_run(E& e, const LineRun& run, LineScratch<typename E::Real>& w) {
  using Real = typename E::Real;
  const LineContact& law = e.law(run.type);
  const Vec3Array& axis = *e.in.axis;
  const int elements = run.element_end - run.element_begin, nodes = law.nodes_j, skipped = run.node_begin - run.row;
  w.clear(static_cast<std::size_t>(std::max(elements * nodes - skipped, 0) + 2 * NodeLayout::pad));
  bool sparse = false, dense = false;
  for (int m = 0; m < elements; ++m) {
    const int j = run.element_begin + m;
    const double c = e.n[0] * axis.x[j] + e.n[1] * axis.y[j] + e.n[2] * axis.z[j];
    const SparseWeight share = sparse_weight(c);
    w.share.push_back(share);
    sparse |= share.value > 0;
    dense |= share.value < 1 || run.begins || run.ends;
    for (int l = std::max(m * nodes - skipped, 0); l < (m + 1) * nodes - skipped; ++l) {
      const double of_node = share.value * end_ramp(l + skipped - m * nodes, nodes, run.begins, run.ends);
      w.sparse[static_cast<std::size_t>(l)] = static_cast<Real>(of_node);
      w.dense[static_cast<std::size_t>(l)] = static_cast<Real>(1 - of_node);
    }
  }
  if (!sparse) return dense_run(e, run);
  node_sum<true>(e, run, law.sparse_i, w.sparse.data(), w.sparse_energy.data());
  if (dense) node_sum<true>(e, run, law.nodes_i, w.dense.data(), w.dense_energy.data());
  for (int m = 0; m < elements; ++m) {
    const SparseWeight& share = w.share[static_cast<std::size_t>(m)];
    if (share.value <= 0 || share.value >= 1) continue;
    double difference = 0;
    for (int l = std::max(m * nodes - skipped, 0); l < (m + 1) * nodes - skipped; ++l)
      difference += end_ramp(l + skipped - m * nodes, nodes, run.begins, run.ends) *
                    (static_cast<double>(w.sparse_energy[static_cast<std::size_t>(l)]) -
                     static_cast<double>(w.dense_energy[static_cast<std::size_t>(l)]));
    // The share depends on the angle: a couple on both.
    const int j = run.element_begin + m, at = j - e.touched_begin;
    const double g = difference * share.derivative;
    const double tx = g * (e.n[1] * axis.z[j] - e.n[2] * axis.y[j]),
                 ty = g * (e.n[2] * axis.x[j] - e.n[0] * axis.z[j]),
                 tz = g * (e.n[0] * axis.y[j] - e.n[1] * axis.x[j]);
    e.sum.tx -= tx;
    e.sum.ty -= ty;
    e.sum.tz -= tz;
    e.out.tx[at] += tx;
    e.out.ty[at] += ty;
    e.out.tz[at] += tz;
  }
}

// Whether all elements of the run cross element i at less than 12 degrees.
template <class E>
HWY_INLINE bool nearly_parallel(const E& e, const LineRun& run) {
  const Vec3Array& axis = *e.in.axis;
  double smallest = 1;
  for (int j = run.element_begin; j < run.element_end; ++j) {
    const double c = e.n[0] * axis.x[j] + e.n[1] * axis.y[j] + e.n[2] * axis.z[j];
    smallest = std::min(smallest, c * c);
  }
  return smallest >= sparse_full_cos2;
}

template <class In, class Real>
HWY_INLINE void all_elements(const In& in, const NeighbourList::Chunk& chunk, LineScratch<Real>& scratch,
                             NodeForces<Real>& forces, ContactBuffer& out) {
  const std::size_t types = in.topology->types.size();
  const Vec3Array &x = in.state->position, &n = *in.axis;
  std::vector<const LineRun*>& even = scratch.even;
  for (int i = chunk.begin; i < chunk.end; ++i) {
    if (in.list->begin(i) == in.list->end(i)) continue;
    const auto none = hn::Zero(typename Element<In>::D());
    Element<In> e{in,
                  forces,
                  out,
                  chunk.touched_begin,
                  static_cast<std::size_t>(in.type[i]) * types,
                  {x.x[i], x.y[i], x.z[i]},
                  {n.x[i], n.y[i], n.z[i]},
                  none,
                  none,
                  none,
                  none,
                  none,
                  none,
                  none,
                  {}};
    even.clear();
    for (const LineRun* run = in.list->begin(i); run != in.list->end(i); ++run) {
      if (static_cast<double>(run->beyond) > in.moved) continue;
      if (e.law(run->type).sparse_i == 0) {
        dense_run(e, *run);
      } else if (nearly_parallel(e, *run)) {
        if (run->begins || run->ends) {
          end_run(e, *run, scratch);
        } else {
          even.push_back(run);
        }
      } else {
        mixed_run(e, *run, scratch);
      }
    }
    if (!even.empty()) {
      const int on_i = e.law(even[0]->type).sparse_i;
      int k = 0;
      for (; k + 2 <= on_i; k += 2) sparse_runs<2>(e, k, on_i, even);
      for (; k < on_i; ++k) sparse_runs<1>(e, k, on_i, even);
    }
    e.add_to(out, i);
  }
}

// The first n entries at p, the others zero; p need not be aligned and nothing behind them is read.
template <class D>
HWY_INLINE hn::Vec<D> load_first(D d, const double* p, std::size_t n) {
#if HWY_TARGET <= HWY_AVX2
  return hn::MaskedLoad(hn::FirstN(d, n), d, p);
#else
  if (n >= hn::Lanes(d)) return hn::LoadU(d, p);
  alignas(64) double some[hn::MaxLanes(d)] = {};
  for (std::size_t k = 0; k < n; ++k) some[k] = p[k];
  return hn::Load(d, some);
#endif
}

template <class D>
HWY_INLINE void store_first(hn::Vec<D> v, D d, double* p, std::size_t n) {
#if HWY_TARGET <= HWY_AVX2
  hn::BlendedStore(v, hn::FirstN(d, n), d, p);
#else
  if (n >= hn::Lanes(d)) return hn::StoreU(v, d, p);
  alignas(64) double all[hn::MaxLanes(d)];
  hn::Store(v, d, all);
  for (std::size_t k = 0; k < n; ++k) p[k] = all[k];
#endif
}

// ContactViscosity::force for a few neighbours at a time: two vectors of a few lanes beat one that is half empty.
void Damping(const Interaction& in, const State& state, const LineList& list, const NeighbourList::Chunk& chunk,
             ContactBuffer& out) {
  const hn::CappedTag<double, 4> d;
  using V = hn::Vec<decltype(d)>;
  const auto lanes = static_cast<int>(hn::Lanes(d));
  const ContactViscosity& c = in.damping.contact;
  const V inner = hn::Set(d, c.inner), per_width = hn::Set(d, 1 / (c.outer - c.inner)), half = hn::Set(d, 0.5);
  const V minus_eta = hn::Set(d, -c.eta), one = hn::Set(d, 1.0), two = hn::Set(d, 2.0), three = hn::Set(d, 3.0);
  const Vec3Array &x = state.position, &v = state.velocity, &w = state.angular_velocity;
  const int first = chunk.touched_begin;
  V power = hn::Zero(d);
  for (int i = chunk.begin; i < chunk.end; ++i) {
    V sfx = hn::Zero(d), sfy = sfx, sfz = sfx, stx = sfx, sty = sfx, stz = sfx;
    bool any = false;
    for (const LineRun* run = list.begin(i); run != list.end(i); ++run) {
      for (int j = run->damped_begin; j < run->damped_end; j += lanes) {
        any = true;
        const auto left = static_cast<std::size_t>(run->damped_end - j);
        const auto at = [&](const std::vector<double>& a) { return load_first(d, a.data() + j, left); };
        const auto of_i = [&](const std::vector<double>& a) { return hn::Set(d, a[static_cast<std::size_t>(i)]); };
        const V dx = hn::Sub(at(x.x), of_i(x.x)), dy = hn::Sub(at(x.y), of_i(x.y)),
                dz = hn::Sub(at(x.z), of_i(x.z));
        const V distance = hn::Sqrt(hn::MulAdd(dx, dx, hn::MulAdd(dy, dy, hn::Mul(dz, dz))));
        const V y = hn::Min(hn::Max(hn::Mul(hn::Sub(distance, inner), per_width), hn::Zero(d)), one);
        const V weight = hn::NegMulAdd(hn::Mul(y, y), hn::NegMulAdd(two, y, three), one);
        const V scale = hn::IfThenElseZero(hn::FirstN(d, left), hn::Mul(minus_eta, weight));
        const V ax = hn::Mul(half, dx), ay = hn::Mul(half, dy), az = hn::Mul(half, dz);
        const V wx = hn::Add(at(w.x), of_i(w.x)), wy = hn::Add(at(w.y), of_i(w.y)),
                wz = hn::Add(at(w.z), of_i(w.z));
        const V rx = hn::MulAdd(wz, ay, hn::NegMulAdd(wy, az, hn::Sub(at(v.x), of_i(v.x))));
        const V ry = hn::MulAdd(wx, az, hn::NegMulAdd(wz, ax, hn::Sub(at(v.y), of_i(v.y))));
        const V rz = hn::MulAdd(wy, ax, hn::NegMulAdd(wx, ay, hn::Sub(at(v.z), of_i(v.z))));
        const V fx = hn::Mul(scale, rx), fy = hn::Mul(scale, ry), fz = hn::Mul(scale, rz);
        const V tx = hn::NegMulAdd(ay, fz, hn::Mul(az, fy)), ty = hn::NegMulAdd(az, fx, hn::Mul(ax, fz)),
                tz = hn::NegMulAdd(ax, fy, hn::Mul(ay, fx));
        power = hn::MulAdd(fx, rx, hn::MulAdd(fy, ry, hn::MulAdd(fz, rz, power)));
        sfx = hn::Sub(sfx, fx), sfy = hn::Sub(sfy, fy), sfz = hn::Sub(sfz, fz);
        stx = hn::Add(stx, tx), sty = hn::Add(sty, ty), stz = hn::Add(stz, tz);
        const auto add = [&](std::vector<double>& a, V what) {
          double* to = a.data() + (j - first);
          store_first(hn::Add(load_first(d, to, left), what), d, to, left);
        };
        add(out.fx, fx), add(out.fy, fy), add(out.fz, fz), add(out.tx, tx), add(out.ty, ty), add(out.tz, tz);
      }
    }
    if (!any) continue;
    const auto total = [&](V a) { return hn::GetLane(hn::SumOfLanes(d, a)); };
    ElementSum{total(sfx), total(sfy), total(sfz), total(stx), total(sty), total(stz), 0.0}.add_to(out, i - first);
  }
  out.power += hn::GetLane(hn::SumOfLanes(d, power));
}

void Mixed(const LineKernelInput<MixedTable, std::int32_t>& in, const NeighbourList::Chunk& chunk,
           LineScratch<float>& scratch, NodeForces<float>& forces, ContactBuffer& out) {
  all_elements(in, chunk, scratch, forces, out);
}

void Full(const LineKernelInput<FullTable, double>& in, const NeighbourList::Chunk& chunk,
          LineScratch<double>& scratch, NodeForces<double>& forces, ContactBuffer& out) {
  all_elements(in, chunk, scratch, forces, out);
}

}  // namespace ropewalk::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace ropewalk {

HWY_EXPORT(Mixed);
HWY_EXPORT(Full);
HWY_EXPORT(Damping);

void line_damping(const Interaction& in, const State& state, const LineList& list,
                  const NeighbourList::Chunk& chunk, ContactBuffer& out) {
  HWY_DYNAMIC_DISPATCH(Damping)(in, state, list, chunk, out);
}

void line_contact(const LineKernelInput<MixedTable, std::int32_t>& in, const NeighbourList::Chunk& chunk,
                  LineScratch<float>& scratch, NodeForces<float>& forces, ContactBuffer& out) {
  HWY_DYNAMIC_DISPATCH(Mixed)(in, chunk, scratch, forces, out);
}

void line_contact(const LineKernelInput<FullTable, double>& in, const NeighbourList::Chunk& chunk,
                  LineScratch<double>& scratch, NodeForces<double>& forces, ContactBuffer& out) {
  HWY_DYNAMIC_DISPATCH(Full)(in, chunk, scratch, forces, out);
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
