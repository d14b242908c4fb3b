// `line`: van der Waals contact of two rigid tube elements as the double line integral, along both axes, of an
// isotropic line density u(rho), rho the distance of two points of the axes.
//
//   U = int ds_i int ds_j u(|x_j + s_j n_j - x_i - s_i n_i|)
//     = sum_{k,l} w_i w_j u(rho_kl),   nodes s_k = ((k + 1/2)/N - 1/2) L, weights w = L/N     (midpoint rule)
//
//   u(rho) = K [ (s/(h + c))^p - (s/(h + c))^q ] W(h),     h = rho - r_i - r_j (the gap)
//
// W falls from 1 at switch_gap to 0 at cutoff_gap by the quintic smoothstep (C2). Below core_gap the second-order
// Taylor polynomial in h continues u: finite, repulsive and C2 for any overlap.
//
// For straight tubes the surface integral of any isotropic atom-atom law equals this integral at every crossing
// angle, u being the Abel inverse of the parallel-tube energy; so no angular factor is needed. The nodes of
// consecutive elements form one uniform row, for which the midpoint rule converges exponentially (line_nodes).
//
// Elements at small angles need fewer nodes. The double sum is off by the Fourier coefficients of u at the wave
// vectors that both rows share: for rows of M and N nodes per length, crossing at an angle, at
//   K^2 = [(m M + n N)^2 + 2 |m n| M N (1 - cos)]/sin^2 (2 pi/L)^2,    m, n integers of opposite sign or one zero,
// so for parallel rows at the common multiples of M and N alone.
//   M and M + 1 nodes with M (M + 1) >= N corrugate no more than parallel rows of N; the wave (1, -1) stays as far
//   out up to sin^2 = 1/(N^2 - M (M + 1)). For N = 6 that is 2 nodes against 3, a sixth of the evaluations, up to
//   10.5 degrees. Crossing tubes corrugate less than parallel ones: at 1.2 times the square, 11.5 degrees, still
//   below 1e-3 of the well, also 0.05 nm inside of it.
//   M nodes against all N: K >= n N, so that only the wave (1, 0) comes near, at M/sin: as far out up to sin = M/N.
//   Hence N/3 nodes against N up to 19.5 degrees, and N/2 against N up to 30.
// Over the last 6 % of each of these angles one sum goes over into the next, w a quintic smoothstep in (n_i.n_j)^2:
//   U = w U_t + (1 - w) U_(t + 1),    the last one with all nodes.
// Where a row ends, single nodes of the other would be felt: a ripple of 12 % in the force that pulls a tube out of
// a bundle. Over the last element of a tube a sum whose other row is sparse therefore fades out linearly from node
// to node, by the ramp r; as the ripple has a whole number of periods in an element, the mean under the ramp is
// zero. What the ramps leave is summed with the *other* row dense, which has no ripple (both where both rows end):
//   U_t = sum_(a, b) r_k r_l (...) + sum_(a or N, b or N) (1 - r_k r_l) (...).
//
// What a sum does to whole tubes is as good as the energy; what turns a single element is not. Along parallel tubes
// R apart a row of M nodes per length presses with a ripple, which the N nodes s of an element of the other tube
// feel as a couple that goes with the shift z of the tubes, for all elements of the tube alike:
//   T = 2 f_M L^2 a sin(2 pi M z/L),   a = sum_s (s/L) sin(2 pi M s/L)/N,
//   f_M = int R/rho u'(rho) cos(2 pi M t/L) dt
// Two (10,10) tubes in the well, eV on the element with more nodes and on that with fewer: 1.5 and 0.25 with two
// nodes against three, 0.18 and 0.01 with three against four, none where M = N. Bonds bear it by shear. More is
// felt of i and j being unlike: which of two has fewer nodes goes by their numbers, so that a rope loses the
// symmetry of its cross-section, and leaves a symmetric state that has become unstable sooner than a heated one.
// With all nodes (SparseNodes{}) it keeps it.
//
// Forces are central between nodes, so force, torque and momentum balance are exact by construction.
// Units eV, nm. u in eV/nm^2. Symmetric under flipping either axis (with the ends of its tube) and, without sparse
// nodes, under exchange of i and j; with them i is the element of lower index.
// Sources: A. N. Volkov, L. V. Zhigilei, J. Phys. Chem. C 114, 5513 (2010), DOI 10.1021/jp906142h (tubular
// potential, which this replaces by an exact line integral); the Abel inverse is derived in
// calibrate/contact/van_der_waals.hpp.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "model/contact/contact.hpp"

namespace ropewalk {

struct RadialTerms {
  double energy = 0;      // u, eV/nm^2
  double derivative = 0;  // du/drho, eV/nm^3
  double second = 0;      // d2u/drho2, eV/nm^4
};

// u(rho) for one pair of tube types.
struct LineDensity {
  double contact = 0;  // r_i + r_j, nm
  double K = 0;        // eV/nm^2
  double s = 0;        // nm
  double c = 0;        // nm
  double p = 10;
  double q = 4;
  double core_gap = 0.2;    // nm
  double switch_gap = 0.9;  // nm
  double cutoff_gap = 1.2;  // nm

  double cutoff() const { return contact + cutoff_gap; }  // of rho
  // Plain arithmetic, selections, exp and log only, so that a loop over pairs of nodes vectorises.
  inline __attribute__((always_inline)) RadialTerms terms(double rho) const {
    const double h = rho - contact, e = std::min(h - core_gap, 0.0);
    const double inv = 1 / (h - e + c), power = std::log(s * inv);
    const double rep = K * std::exp(p * power), att = K * std::exp(q * power);
    const double v0 = rep - att, v1 = (q * att - p * rep) * inv;
    const double v2 = (p * (p + 1) * rep - q * (q + 1) * att) * inv * inv;
    const double v = v0 + e * (v1 + 0.5 * e * v2), dv = v1 + e * v2;
    const double per_width = 1 / (cutoff_gap - switch_gap);
    const double t = std::min(std::max((h - switch_gap) * per_width, 0.0), 1.0);
    // 1 at t = 0 and, in floating point too, 0 at t = 1: nothing beyond the cutoff needs a mask.
    const double r = 1 - t, w = r * r * r * (1 + t * (3 + 6 * t));
    const double dw = -30 * t * t * r * r * per_width, ddw = -60 * t * r * (1 - 2 * t) * per_width * per_width;
    return {v * w, dv * w + v * dw, v2 * w + 2 * dv * dw + v * ddw};
  }
  double energy(double rho) const { return terms(rho).energy; }
};

// The law with another, nearer cutoff (nm, of rho). The taper begins at the same part of the way from the well to
// the cutoff, so that it never reaches into the well.
LineDensity with_cutoff(LineDensity density, double cutoff);

// The sum that stands for all nodes up to an angle.
struct SparseSum {
  int i = 0, j = 0;      // nodes of i, of j; 0: all of them
  double from_cos2 = 1;  // its share w is 0 at larger angles
  double full_cos2 = 1;  // and 1 at smaller ones, up to where the sum before it ends
};

// Share w of the sum `first`, and its derivative in n_i.n_j; the next one has the rest.
struct SumShare {
  int first = 0;
  double value = 1, derivative = 0;
};

// The sums by rising angle; behind the last of them, and where there is none, all nodes.
struct SparseNodes {
  static constexpr int most = 3;
  std::array<SparseSum, most> sum{};
  int count = 0;

  int first_of(double cos2) const {  // with a share at this angle
    int t = 0;
    while (t < count && cos2 <= sum[static_cast<std::size_t>(t)].from_cos2) ++t;
    return t;
  }
  int last_of(double cos2) const {
    int t = 0;
    while (t < count && cos2 < sum[static_cast<std::size_t>(t)].full_cos2) ++t;
    return t;
  }
  // j is summed over nodes of its own rather than over all.
  bool thins_j(int t) const { return t < count && sum[static_cast<std::size_t>(t)].j > 0; }
  SumShare share(double cosine) const {
    const double c2 = cosine * cosine;
    const int t = first_of(c2);
    return t == last_of(c2) ? SumShare{t, 1, 0} : share(t, cosine);
  }
  // Of sum t, the rest being that of the next one: where no other has a share.
  SumShare share(int t, double cosine) const {
    const double c2 = cosine * cosine;
    const SparseSum& at = sum[static_cast<std::size_t>(t)];
    const double per_width = 1 / (at.full_cos2 - at.from_cos2);
    const double x = std::max(std::min((c2 - at.from_cos2) * per_width, 1.0), 0.0), r = 1 - x;
    return {t, x * x * x * (10 - x * (15 - 6 * x)), 60 * x * x * r * r * cosine * per_width};
  }
};

// r: share of a sum whose other row is sparse in what acts on node l of `nodes`.
inline double end_ramp(int l, int nodes, const TubeEnds& ends) {
  const double along = (l + 0.5) / nodes;
  return ends.begins && ends.ends ? 0.0 : ends.begins ? along : ends.ends ? 1 - along : 1.0;
}

// One pair of elements.
struct LineContact {
  LineDensity density;
  double length_i = 0, length_j = 0;  // nm
  int nodes_i = 1, nodes_j = 1;
  SparseNodes sparse;
  TubeEnds ends_i, ends_j;

  // Nodes of sum t, and of what its ramps leave: a row is dense where the other one ends.
  int sum_nodes_i(int t) const {
    const int own = t < sparse.count ? sparse.sum[static_cast<std::size_t>(t)].i : 0;
    return own > 0 ? own : nodes_i;
  }
  int sum_nodes_j(int t) const {
    const int own = t < sparse.count ? sparse.sum[static_cast<std::size_t>(t)].j : 0;
    return own > 0 ? own : nodes_j;
  }
  int end_nodes_i(int t) const { return ends_j.any() ? nodes_i : sum_nodes_i(t); }
  int end_nodes_j(int t) const { return ends_i.any() ? nodes_j : sum_nodes_j(t); }
  // Whether sum t fades at these ends, and how much of it is left for nodes k of on_i and l of on_j.
  bool fades(int t) const {
    return (ends_i.any() && sum_nodes_j(t) < nodes_j) || (ends_j.any() && sum_nodes_i(t) < nodes_i);
  }
  double ramp(int t, int k, int on_i, int l, int on_j) const {
    return (sum_nodes_j(t) < nodes_j ? end_ramp(k, on_i, ends_i) : 1.0) *
           (sum_nodes_i(t) < nodes_i ? end_ramp(l, on_j, ends_j) : 1.0);
  }
  // Of the element centres: beyond it no two nodes reach each other, however the elements are turned.
  double cutoff() const {
    return density.cutoff() + 0.5 * (length_i * (1 - 1.0 / nodes_i) + length_j * (1 - 1.0 / nodes_j));
  }
  // separation = x_j - x_i; n_i, n_j unit axes.
  PairForce energy_and_gradient(const Vector3& separation, const Vector3& n_i, const Vector3& n_j) const;
  double energy(const Vector3& separation, const Vector3& n_i, const Vector3& n_j) const;
  // The same with u by a function of the squared distance (nm^2), where one is at hand that costs less.
  template <class U>
  double energy_by(const U& u, const Vector3& separation, const Vector3& n_i, const Vector3& n_j) const;

 private:
  template <class U>
  double sum_by(const U& u, int t, const Vector3& separation, const Vector3& n_i, const Vector3& n_j) const;
  template <class Share>
  PairForce node_sum(int on_i, int on_j, const Share& share, const Vector3& separation, const Vector3& n_i,
                     const Vector3& n_j) const;
  PairForce sum(int t, const Vector3& separation, const Vector3& n_i, const Vector3& n_j) const;
};

// Place of node k of `nodes` on an element, from its centre (nm).
inline double line_node(int k, int nodes, double length) { return ((k + 0.5) / nodes - 0.5) * length; }

// Nodes per element, spaced by at most 0.33 sqrt(R0 g0), R0 the distance and g0 the gap of two parallel tubes at
// rest: along the axes u is as wide as sqrt(R0 g0). Keeps the corrugation below 1e-3 of the well 0.05 nm inside of
// it, and below 1e-4 in it, for r = 0.2 .. 1.4 nm.
inline int line_nodes(double length, double pair_spacing, double contact) {
  const double spacing = 0.33 * std::sqrt(pair_spacing * (pair_spacing - contact));
  return std::max(1, static_cast<int>(std::ceil(length / spacing - 1e-9)));
}

// For rows of `nodes` per element, the finest of a scene: one choice for all its tubes. At least two nodes: a
// single one could not turn its element.
inline SparseNodes sparse_nodes(int nodes) {
  SparseNodes out;
  double before = 0;  // rad: where the sum before ends
  const auto add = [&](int i, int j, double sine2) {
    const double from = std::asin(std::sqrt(sine2)), full = std::max(0.94 * from, before);
    if (from < full + 0.01) return;  // rad
    out.sum[static_cast<std::size_t>(out.count++)] = {i, j, 1 - sine2, std::pow(std::cos(full), 2)};
    before = from;
  };
  constexpr double widest = 0.09549150281253;  // sin^2 of 18 degrees
  int m = 2;
  while (m * (m + 1) < nodes) ++m;
  if (m + 1 < nodes) add(m, m + 1, std::min(widest, 1.2 / (double(nodes) * nodes - m * (m + 1))));
  int last = 0;
  for (const int parts : {3, 2}) {
    const int few = std::max(2, (nodes + parts - 1) / parts);
    if (few >= nodes || few == last) continue;
    add(few, 0, double(few) * few / (double(nodes) * nodes));
    last = few;
  }
  return out;
}

// With sparse nodes, for tubes of one type.
inline LineContact line_pair(const LineDensity& density, double length_i, double length_j, int nodes_i,
                             int nodes_j) {
  return {density, length_i, length_j, nodes_i, nodes_j, sparse_nodes(std::max(nodes_i, nodes_j)), {}, {}};
}

// Energy per length (eV/nm) of two infinite parallel tubes and energy (eV) of two infinite tubes crossed at
// `angle`; and the distance (nm) at which each is lowest.
struct LineWell {
  double distance = 0, energy = 0;
};
double line_parallel_energy(const LineDensity& density, double distance);
double line_crossed_energy(const LineDensity& density, double distance, double angle);
LineWell line_parallel_well(const LineDensity& density);
LineWell line_crossed_well(const LineDensity& density, double angle);

// --- One law for all tubes --------------------------------------------------------------------------
//
// In units of the atom-atom law (length sigma, K in eps n_i n_j sigma^2 g) the parameters of u are smooth functions
// of the two curvatures:
//   x = sigma (1/r_i + 1/r_j)/2,   y = sigma^2 (1/r_i - 1/r_j)^2/4,   g = 2 sqrt(r_i r_j)/(r_i + r_j),
//   ln K', s', c', p, q  =  a0 + a1 x + a2 x^2 + a3 x^3 + (a4 + a5 x) y.
// g is the limit of wide tubes: the parallel energy goes as sqrt(r_i r_j/(r_i + r_j)) there (Derjaguin), and u,
// whose line integral it is over a length that goes as sqrt(r_i + r_j), as sqrt(r_i r_j)/(r_i + r_j). Valid for r =
// 0.3 .. 1.4 nm and for the cutoff (in units of sigma) that it was fitted for.
struct UniversalLine {
  static constexpr int terms = 6;
  using Row = std::array<double, terms>;
  double epsilon = 0;    // eV, of the atom-atom law
  double sigma = 0;      // nm
  double lj_cutoff = 0;  // nm; 0: none
  Row log_K{}, s{}, c{}, p{}, q{};
  struct Errors {
    Row log_K{}, s{}, c{}, p{}, q{};
  };
  Errors standard_errors;
  double core_gap = 0, switch_gap = 0, cutoff_gap = 0;  // nm

  bool operator==(const UniversalLine& o) const {
    return epsilon == o.epsilon && sigma == o.sigma && lj_cutoff == o.lj_cutoff && log_K == o.log_K && s == o.s &&
           c == o.c && p == o.p && q == o.q && core_gap == o.core_gap && switch_gap == o.switch_gap &&
           cutoff_gap == o.cutoff_gap;
  }
  // r nm, n atoms per nm^2.
  LineDensity density(double r_i, double n_i, double r_j, double n_j) const;
};

// --- Definitions ------------------------------------------------------------------------------------

template <class Share>
PairForce LineContact::node_sum(int on_i, int on_j, const Share& share, const Vector3& separation,
                                const Vector3& n_i, const Vector3& n_j) const {
  PairForce f;
  const double reach2 = density.cutoff() * density.cutoff();
  for (int k = 0; k < on_i; ++k) {
    const double si = line_node(k, on_i, length_i);
    for (int l = 0; l < on_j; ++l) {
      const double weight = share(k, l) * length_i / on_i * length_j / on_j;
      const double sj = line_node(l, on_j, length_j);
      const Vector3 d = separation + sj * n_j - si * n_i;
      if (d.squaredNorm() >= reach2) continue;
      const double rho = detail::safe_distance(d);
      const RadialTerms t = density.terms(rho);
      const Vector3 force = -weight * t.derivative / rho * d;
      f.energy += weight * t.energy;
      f.force_j += force;
      f.torque_i -= si * n_i.cross(force);
      f.torque_j += sj * n_j.cross(force);
    }
  }
  return f;
}

inline PairForce LineContact::sum(int t, const Vector3& separation, const Vector3& n_i, const Vector3& n_j) const {
  const int on_i = sum_nodes_i(t), on_j = sum_nodes_j(t);
  const auto faded = [&](int k, int l) { return ramp(t, k, on_i, l, on_j); };
  PairForce f = node_sum(on_i, on_j, faded, separation, n_i, n_j);
  if (!fades(t)) return f;
  const int left_i = end_nodes_i(t), left_j = end_nodes_j(t);
  const auto left = [&](int k, int l) { return 1 - ramp(t, k, left_i, l, left_j); };
  const PairForce rest = node_sum(left_i, left_j, left, separation, n_i, n_j);
  f.energy += rest.energy;
  f.force_j += rest.force_j;
  f.torque_i += rest.torque_i;
  f.torque_j += rest.torque_j;
  return f;
}

inline PairForce LineContact::energy_and_gradient(const Vector3& separation, const Vector3& n_i,
                                                  const Vector3& n_j) const {
  const SumShare w = sparse.share(n_i.dot(n_j));
  const PairForce near = sum(w.first, separation, n_i, n_j);
  if (w.value >= 1) return near;

  PairForce f = sum(w.first + 1, separation, n_i, n_j);
  const Vector3 turn = (near.energy - f.energy) * w.derivative * n_i.cross(n_j);
  f.energy += w.value * (near.energy - f.energy);
  f.force_j += w.value * (near.force_j - f.force_j);
  f.torque_i += w.value * (near.torque_i - f.torque_i) - turn;
  f.torque_j += w.value * (near.torque_j - f.torque_j) + turn;
  return f;
}

inline double LineContact::energy(const Vector3& separation, const Vector3& n_i, const Vector3& n_j) const {
  return energy_and_gradient(separation, n_i, n_j).energy;
}

template <class U>
double LineContact::sum_by(const U& u, int t, const Vector3& separation, const Vector3& n_i,
                           const Vector3& n_j) const {
  const auto over = [&](int on_i, int on_j, const auto& share) {
    double energy = 0;
    for (int k = 0; k < on_i; ++k) {
      const Vector3 from = separation - line_node(k, on_i, length_i) * n_i;
      for (int l = 0; l < on_j; ++l)
        energy += share(k, l) * u((from + line_node(l, on_j, length_j) * n_j).squaredNorm());
    }
    return energy * length_i / on_i * length_j / on_j;
  };
  const int on_i = sum_nodes_i(t), on_j = sum_nodes_j(t), left_i = end_nodes_i(t), left_j = end_nodes_j(t);
  if (!fades(t)) return over(on_i, on_j, [](int, int) { return 1.0; });
  return over(on_i, on_j, [&](int k, int l) { return ramp(t, k, on_i, l, on_j); }) +
         over(left_i, left_j, [&](int k, int l) { return 1 - ramp(t, k, left_i, l, left_j); });
}

template <class U>
double LineContact::energy_by(const U& u, const Vector3& separation, const Vector3& n_i, const Vector3& n_j) const {
  const SumShare w = sparse.share(n_i.dot(n_j));
  const double near = sum_by(u, w.first, separation, n_i, n_j);
  return w.value >= 1 ? near : w.value * near + (1 - w.value) * sum_by(u, w.first + 1, separation, n_i, n_j);
}

namespace detail {

template <class F>
LineWell lowest_point(F energy, double from, double to) {
  constexpr int grid = 200;
  const double step = (to - from) / grid;
  int lowest = 0;
  for (int k = 1; k <= grid; ++k)
    if (energy(from + k * step) < energy(from + lowest * step)) lowest = k;
  const double part = 0.5 * (std::sqrt(5.0) - 1);
  double a = from + std::max(lowest - 1, 0) * step, b = from + std::min(lowest + 1, grid) * step;
  while (b - a > 1e-8) {
    const double x1 = b - part * (b - a), x2 = a + part * (b - a);
    (energy(x1) < energy(x2) ? b : a) = energy(x1) < energy(x2) ? x2 : x1;
  }
  return {0.5 * (a + b), energy(0.5 * (a + b))};
}

}  // namespace detail

namespace detail {

// Composite Simpson rule with an even number of intervals.
template <class F>
double simpson(F f, double from, double to, int intervals) {
  const double step = (to - from) / intervals;
  double sum = f(from) + f(to);
  for (int k = 1; k < intervals; ++k) sum += (k % 2 ? 4 : 2) * f(from + k * step);
  return sum * step / 3;
}

}  // namespace detail

inline double line_parallel_energy(const LineDensity& density, double distance) {
  const double reach2 = density.cutoff() * density.cutoff() - distance * distance;
  if (reach2 <= 0) return 0;
  return 2 * detail::simpson([&](double t) { return density.energy(std::hypot(distance, t)); }, 0,
                             std::sqrt(reach2), 400);
}

inline double line_crossed_energy(const LineDensity& density, double distance, double angle) {
  if (distance >= density.cutoff()) return 0;
  // Closely spaced where the wall is steep: rho = distance + span x^2.
  const double span = density.cutoff() - distance;
  const auto integrand = [&](double x) {
    const double rho = distance + span * x * x;
    return 2 * span * x * rho * density.energy(rho);
  };
  return 2 * units::pi * detail::simpson(integrand, 0, 1, 400) / std::sin(angle);
}

inline LineDensity with_cutoff(LineDensity density, double cutoff) {
  const double well = line_parallel_well(density).distance - density.contact;
  const double begins = (density.switch_gap - well) / (density.cutoff_gap - well);
  density.cutoff_gap = cutoff - density.contact;
  density.switch_gap = well + begins * (density.cutoff_gap - well);
  return density;
}

inline LineWell line_parallel_well(const LineDensity& d) {
  return detail::lowest_point([&](double r) { return line_parallel_energy(d, r); }, d.contact + d.core_gap,
                              d.cutoff());
}

inline LineWell line_crossed_well(const LineDensity& d, double angle) {
  return detail::lowest_point([&](double r) { return line_crossed_energy(d, r, angle); }, d.contact + d.core_gap,
                              d.cutoff());
}

inline LineDensity UniversalLine::density(double r_i, double n_i, double r_j, double n_j) const {
  const double x = 0.5 * sigma * (1 / r_i + 1 / r_j);
  const double y = 0.25 * sigma * sigma * (1 / r_i - 1 / r_j) * (1 / r_i - 1 / r_j);
  const auto at = [&](const Row& a) { return a[0] + x * (a[1] + x * (a[2] + x * a[3])) + (a[4] + a[5] * x) * y; };
  LineDensity d;
  d.contact = r_i + r_j;
  d.K = epsilon * n_i * n_j * sigma * sigma * 2 * std::sqrt(r_i * r_j) / (r_i + r_j) * std::exp(at(log_K));
  d.s = sigma * at(s);
  d.c = sigma * at(c);
  d.p = at(p);
  d.q = at(q);
  d.core_gap = core_gap;
  d.switch_gap = switch_gap;
  d.cutoff_gap = cutoff_gap;
  return d;
}

}  // namespace ropewalk
