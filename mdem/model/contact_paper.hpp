// `paper`: the published one-point anisotropic van der Waals contact between two rigid tube elements.
//
//   U(R, theta, gamma) = Gamma(R, gamma) W(R) V(D),      D = R / (r Theta(theta)) - 2
//   V     = 4 eps (A / D^alpha - B / D^beta)
//   Theta = 1 + sum_{i=1..5} C_i ((-1)^(i-1) + cos 2 i theta)   theta: centre line against bisector of the axes
//   Gamma = 1 + C_gamma (R/r)^delta (1 - cos 2 gamma)           gamma: crossing angle; frozen below R/r = 2.75
//   W     = cubic switch, 1 at 6 r to 0 at 8 r
//
// Force and both torques are the exact gradient of this one energy. It is evaluated through the invariants
//   p = n_i.u,  q = n_j.u,  c = n_i.n_j,  u = separation / R,  x = cos^2 theta,
// in which it is a polynomial in x: no arc cosine, hence no NaN for collinear elements.
//
// Three places of the published form are not continuous. Ours are, by documented choices:
//  1. Core. V diverges at D = 0 and published codes cut it off. Below D = core_gap the second-order Taylor
//     polynomial continues V: energy, force and stiffness continuous, finite down to R = 0.
//  2. gamma = 90 deg. The bisector of two axes (of which neither has a direction) jumps from n_i + n_j to
//     n_i - n_j. Within |c| < bisector_blend the two values of x are mixed by a C1 weight; outside, and
//     wherever the line of centres is normal to both axes, the published value stands.
//  3. Gamma's freeze has a kink. It is rounded by a parabola of half-width freeze_blend (C1); the largest
//     change of its argument is freeze_blend/4.
//
// Units eV, nm. Valid for the chirality it was fitted to ((10,10) as published); R/r does not transfer it to
// other radii. Symmetric under exchange of i and j and under flipping either axis.
// Source: I. Ostanin, R. Ballarini, D. Potyondy, T. Dumitrica, J. Mech. Phys. Solids 61, 762 (2013),
// DOI 10.1016/j.jmps.2012.10.016.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "model/contact.hpp"

namespace ropewalk {

// dU with respect to the invariants of a pair.
template <class T>
struct PairTerms {
  T energy, d_r, d_p, d_q, d_c;
  T d_c_crossing;  // the part of d_c that comes from the crossing factor alone (legacy torque)
};

// x^-alpha, x^-beta and x^delta, given 1/x. The published exponents (9.5, 4, -7.5) need one square root and no
// pow, so that a loop over pairs vectorises.
struct PublishedPowers {
  template <class T>
  static T repulsive(T, T inverse, double) {
    const T i2 = inverse * inverse, i4 = i2 * i2;
    return i4 * i4 * inverse * std::sqrt(inverse);
  }
  template <class T>
  static T attractive(T, T inverse, double) {
    const T i2 = inverse * inverse;
    return i2 * i2;
  }
  template <class T>
  static T crossing(T, T inverse, double) {
    const T i2 = inverse * inverse;
    return i2 * i2 * i2 * inverse * std::sqrt(inverse);
  }
};

struct GeneralPowers {
  template <class T>
  static T repulsive(T x, T, double alpha) {
    return std::pow(x, T(-alpha));
  }
  template <class T>
  static T attractive(T x, T, double beta) {
    return std::pow(x, T(-beta));
  }
  template <class T>
  static T crossing(T x, T, double delta) {
    return std::pow(x, T(delta));
  }
};

struct PaperContact {
  double radius = 0;      // r, nm
  double epsilon = 0;     // eV
  double repulsion = 0;   // A
  double attraction = 0;  // B
  double alpha = 9.5;
  double beta = 4.0;
  std::array<double, 5> angular{};  // C_1 .. C_5
  double crossing = 0;              // C_gamma
  double delta = -7.5;
  double freeze = 2.75;                         // R/r below which Gamma is frozen
  double switch_start = 6.0;                    // R/r
  double cutoff_ratio = 8.0;                    // R/r
  double core_gap = 0.4;                        // D below which V is continued by its Taylor polynomial
  double freeze_blend = 0.02;                   // R/r
  double bisector_blend = 0.17364817766693033;  // |cos gamma|: within 10 degrees of a right angle

  double cutoff() const { return cutoff_ratio * radius; }
  bool has_published_powers() const { return alpha == 9.5 && beta == 4.0 && delta == -7.5; }

  // U and its derivatives. Plain arithmetic and selections only, so that a loop over pairs vectorises.
  template <class Powers, class T>
  inline __attribute__((always_inline)) PairTerms<T> terms(T r, T p, T q, T c) const {
    const T inv_radius = T(1 / radius), inv_blend = T(1 / bisector_blend);
    const T inv_freeze = T(0.5 / freeze_blend), inv_switch = T(1 / (cutoff_ratio - switch_start));

    // x = cos^2 theta for the two bisectors, and the weight of the first.
    const T y = std::min(std::max(c * inv_blend, T(-1)), T(1));
    const T w = T(0.5) + y * (T(0.75) - T(0.25) * y * y);
    const T w_c = T(0.75) * (1 - y * y) * inv_blend;
    const T sum = p + q, dif = p - q;
    // Where a denominator could vanish its weight is zero: the bound only keeps 0 * (0/0) away.
    const T np = std::max(2 + 2 * c, T(1)), nm = std::max(2 - 2 * c, T(1));
    const T both = 1 / (np * nm);
    const T ip = nm * both, im = np * both;
    const T xp = sum * sum * ip, xm = dif * dif * im;
    const T x = w * xp + (1 - w) * xm;
    const T gp = 2 * w * sum * ip, gm = 2 * (1 - w) * dif * im;
    const T x_p = gp + gm, x_q = gp - gm;
    const T x_c = w_c * (xp - xm) - 2 * w * xp * ip + 2 * (1 - w) * xm * im;

    // Theta: cos 2 i theta is the Chebyshev polynomial T_i(z), z = 2x - 1; the sum in powers of z, whose
    // coefficients a compiler takes out of a loop over pairs.
    const T c1 = T(angular[0]), c2 = T(angular[1]), c3 = T(angular[2]), c4 = T(angular[3]), c5 = T(angular[4]);
    const T a0 = 1 + c1 - 2 * c2 + c3 + c5, a1 = c1 - 3 * c3 + 5 * c5, a2 = 2 * c2 - 8 * c4;
    const T a3 = 4 * c3 - 20 * c5, a4 = 8 * c4, a5 = 16 * c5;
    const T z = 2 * x - 1;
    const T theta = a0 + z * (a1 + z * (a2 + z * (a3 + z * (a4 + z * a5))));
    const T theta_x = 2 * a1 + z * (4 * a2 + z * (6 * a3 + z * (8 * a4 + z * (10 * a5))));

    // V with its core.
    const T rho = r * inv_radius;
    const T inv_theta = 1 / theta;
    const T d = rho * inv_theta - 2;
    const T dv = std::max(d, T(core_gap));
    const T inv_dv = 1 / dv;
    const T rep = T(4 * epsilon * repulsion) * Powers::repulsive(dv, inv_dv, alpha);
    const T att = T(4 * epsilon * attraction) * Powers::attractive(dv, inv_dv, beta);
    const T v0 = rep - att;
    const T v1 = (T(beta) * att - T(alpha) * rep) * inv_dv;
    const T v2 = (T(alpha * (alpha + 1)) * rep - T(beta * (beta + 1)) * att) * inv_dv * inv_dv;
    const T e = d - dv;
    const T v = v0 + e * (v1 + T(0.5) * e * v2);
    const T v_d = v1 + e * v2;

    // Gamma, frozen by a smooth maximum.
    const T s = std::min(std::max((rho - T(freeze - freeze_blend)) * inv_freeze, T(0)), T(1));
    const T rho_e = std::max(rho, T(freeze + freeze_blend)) - T(freeze_blend) * (1 - s * s);
    const T inv_rho_e = 1 / rho_e;
    const T g = T(2 * crossing) * Powers::crossing(rho_e, inv_rho_e, delta);
    const T sin2 = 1 - c * c;
    const T gam = 1 + g * sin2;
    const T gam_r = g * sin2 * T(delta) * inv_rho_e * s * inv_radius;
    const T gam_c = -2 * g * c;

    // W.
    const T k = std::min(std::max((rho - T(switch_start)) * inv_switch, T(0)), T(1));
    const T sw = 1 - k * k * (3 - 2 * k);
    const T sw_r = -6 * k * (1 - k) * inv_switch * inv_radius;

    const T gv = gam * sw * v_d;
    const T d_x = -gv * (d + 2) * theta_x * inv_theta;  // dD/dx = -(D + 2) Theta'/Theta
    PairTerms<T> out;
    out.energy = gam * sw * v;
    out.d_r = gv * inv_theta * inv_radius + (gam_r * sw + gam * sw_r) * v;
    out.d_p = d_x * x_p;
    out.d_q = d_x * x_q;
    out.d_c_crossing = gam_c * sw * v;
    out.d_c = d_x * x_c + out.d_c_crossing;
    return out;
  }

  PairTerms<double> terms(double r, double p, double q, double c) const {
    return has_published_powers() ? terms<PublishedPowers, double>(r, p, q, c)
                                  : terms<GeneralPowers, double>(r, p, q, c);
  }

  // separation = x_j - x_i; n_i, n_j unit axes.
  PairForce energy_and_gradient(const Vector3& separation, const Vector3& n_i, const Vector3& n_j) const;
  double energy(const Vector3& separation, const Vector3& n_i, const Vector3& n_j) const;

  // The torque of the published force code, which leaves out what comes from theta. Not the gradient of any
  // energy: undamped systems gain energy. For comparison only.
  PairForce legacy_torque(const Vector3& separation, const Vector3& n_i, const Vector3& n_j) const;
};

namespace detail {

inline PairForce assemble(const PairTerms<double>& t, double r, const Vector3& u, double p, double q,
                          const Vector3& n_i, const Vector3& n_j) {
  PairForce f;
  f.energy = t.energy;
  f.force_j = -t.d_r * u - (t.d_p * (n_i - p * u) + t.d_q * (n_j - q * u)) / r;
  f.torque_i = (t.d_p * u + t.d_c * n_j).cross(n_i);
  f.torque_j = (t.d_q * u + t.d_c * n_i).cross(n_j);
  return f;
}

}  // namespace detail

inline PairForce PaperContact::energy_and_gradient(const Vector3& separation, const Vector3& n_i,
                                                   const Vector3& n_j) const {
  const double r = detail::safe_distance(separation);
  const Vector3 u = separation / r;
  const double p = n_i.dot(u), q = n_j.dot(u);
  return detail::assemble(terms(r, p, q, n_i.dot(n_j)), r, u, p, q, n_i, n_j);
}

inline double PaperContact::energy(const Vector3& separation, const Vector3& n_i, const Vector3& n_j) const {
  const double r = detail::safe_distance(separation);
  const Vector3 u = separation / r;
  return terms(r, n_i.dot(u), n_j.dot(u), n_i.dot(n_j)).energy;
}

inline PairForce PaperContact::legacy_torque(const Vector3& separation, const Vector3& n_i,
                                             const Vector3& n_j) const {
  const double r = detail::safe_distance(separation);
  const Vector3 u = separation / r;
  const double p = n_i.dot(u), q = n_j.dot(u), c = n_i.dot(n_j);
  const PairTerms<double> t = terms(r, p, q, c);
  PairForce f = detail::assemble(t, r, u, p, q, n_i, n_j);
  f.torque_i = t.d_c_crossing * n_j.cross(n_i);
  f.torque_j = t.d_c_crossing * n_i.cross(n_j);
  return f;
}

// Energy per length (eV/nm) of two long parallel rows of elements, element beside element.
inline double paper_parallel_energy(const PaperContact& contact, double element_length, double distance) {
  const int reach = static_cast<int>(contact.cutoff() / element_length) + 1;
  double sum = 0;
  for (int k = -reach; k <= reach; ++k)
    sum += contact.energy({distance, 0, k * element_length}, Vector3::UnitZ(), Vector3::UnitZ());
  return sum / element_length;
}

// Energy (eV) of two long rows that cross at `angle`, each at a quarter of an element.
inline double paper_crossed_energy(const PaperContact& contact, double element_length, double distance,
                                   double angle) {
  const Vector3 n_i = Vector3::UnitZ(), n_j(0, std::sin(angle), std::cos(angle));
  const int reach = static_cast<int>(contact.cutoff() / (element_length * std::sin(angle))) + 1;
  double sum = 0;
  for (int k = -reach; k <= reach; ++k)
    for (int l = -reach; l <= reach; ++l)
      sum += contact.energy(
          Vector3(distance, 0, 0) + (l + 0.25) * element_length * n_j - (k + 0.25) * element_length * n_i, n_i,
          n_j);
  return sum;
}

}  // namespace ropewalk
