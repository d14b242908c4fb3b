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
// Corrugation: the double sum over two rows of nodes differs from the double integral by the Fourier components of
// u at the wave vectors that both rows share. Two parallel rows with the node spacing D share the multiples of 2
// pi/D. The first multiple gives the largest error: the energy per length of two tubes at the distance R, one of
// them shifted by z along its axis, oscillates by
//   dE(z) = 2 cos(2 pi z/D) int u(sqrt(R^2 + t^2)) cos(2 pi t/D) dt.
// The amplitude falls exponentially with 1/D (line_nodes). Rows that are strained or cross share fewer wave
// vectors.
//
// Forces are central between nodes, so force, torque and momentum balance are exact by construction.
// Units eV, nm. u in eV/nm^2. Symmetric under exchange of i and j and under flipping either axis.
// Sources: A. N. Volkov, L. V. Zhigilei, J. Phys. Chem. C 114, 5513 (2010), DOI 10.1021/jp906142h (tubular
// potential, which this replaces by an exact line integral); the Abel inverse is derived in
// calibrate/contact/van_der_waals.hpp.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "model/contact/contact.hpp"
#include "model/forms.hpp"

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

  double cutoff() const { return contact + cutoff_gap; }  // cutoff of rho
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

// One pair of elements.
struct LineContact {
  LineDensity density;
  double length_i = 0, length_j = 0;  // nm
  int nodes_i = 1, nodes_j = 1;

  // The distance of element centres beyond which no two nodes reach each other, however the elements are turned.
  double cutoff() const {
    return density.cutoff() + 0.5 * (length_i * (1 - 1.0 / nodes_i) + length_j * (1 - 1.0 / nodes_j));
  }
  // separation = x_j - x_i; n_i, n_j unit axes.
  PairForce energy_and_gradient(const Vector3& separation, const Vector3& n_i, const Vector3& n_j) const;
  double energy(const Vector3& separation, const Vector3& n_i, const Vector3& n_j) const;
  // The same with u by a function of the squared distance (nm^2), where one is at hand that costs less.
  template <class U>
  double energy_by(const U& u, const Vector3& separation, const Vector3& n_i, const Vector3& n_j) const;
};

using forms::line_node;

// Nodes per element, spaced by at most 0.4 sqrt(R0 g0), R0 the distance and g0 the gap of two parallel tubes at
// rest: along the axes u is as wide as sqrt(R0 g0). Keeps the corrugation below 2.5e-4 of the well at rest and
// below 6e-3 of it where tubes are pressed 0.05 nm closer, for r = 0.2 .. 1.4 nm and any axial strain. For
// statics 0.25: a tube slides along others without a stiffness of its own, so that even such a corrugation makes many
// states of rest of one.
inline int line_nodes(double length, double pair_spacing, double contact, bool for_statics = false) {
  const double spacing = (for_statics ? 0.25 : 0.4) * std::sqrt(pair_spacing * (pair_spacing - contact));
  return std::max(1, static_cast<int>(std::ceil(length / spacing - 1e-9)));
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
  double epsilon = 0;    // depth of the atom-atom law, eV
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

inline PairForce LineContact::energy_and_gradient(const Vector3& separation, const Vector3& n_i,
                                                  const Vector3& n_j) const {
  PairForce f;
  const double reach2 = density.cutoff() * density.cutoff();
  const double weight = length_i / nodes_i * length_j / nodes_j;
  for (int k = 0; k < nodes_i; ++k) {
    const double si = line_node(k, nodes_i, length_i);
    for (int l = 0; l < nodes_j; ++l) {
      const double sj = line_node(l, nodes_j, length_j);
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

inline double LineContact::energy(const Vector3& separation, const Vector3& n_i, const Vector3& n_j) const {
  return energy_and_gradient(separation, n_i, n_j).energy;
}

template <class U>
double LineContact::energy_by(const U& u, const Vector3& separation, const Vector3& n_i, const Vector3& n_j) const {
  double energy = 0;
  for (int k = 0; k < nodes_i; ++k) {
    const Vector3 from = separation - line_node(k, nodes_i, length_i) * n_i;
    for (int l = 0; l < nodes_j; ++l) energy += u((from + line_node(l, nodes_j, length_j) * n_j).squaredNorm());
  }
  return energy * length_i / nodes_i * length_j / nodes_j;
}

namespace detail {

template <class F>
LineWell lowest_point(F energy, double from, double to) {
  constexpr int grid = 200;
  const double step = (to - from) / grid;
  int lowest = 0;
  double least = energy(from);
  for (int k = 1; k <= grid; ++k)
    if (const double e = energy(from + k * step); e < least) {
      lowest = k;
      least = e;
    }
  const double part = 0.5 * (std::sqrt(5.0) - 1);
  double a = from + std::max(lowest - 1, 0) * step, b = from + std::min(lowest + 1, grid) * step;
  while (b - a > 1e-8) {
    const double x1 = b - part * (b - a), x2 = a + part * (b - a);
    const bool left = energy(x1) < energy(x2);
    (left ? b : a) = left ? x2 : x1;
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
