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

#include "model/contact/contact.hpp"

namespace ropewalk {

// dU with respect to the invariants of a pair.
template <class T>
struct PairTerms {
  T energy, d_r, d_p, d_q, d_c;
  T d_c_crossing;  // the part of d_c that comes from the crossing factor alone (legacy torque)
};

// x^-alpha, x^-beta and x^delta, of an x whose inverse is kept. The published exponents (9.5, 4, -7.5) need one
// inverse root and no pow, so that a loop over pairs vectorises.
struct PublishedPowers {
  template <class T>
  struct Of {
    T root, inverse;  // x^-1/2, x^-1
    inline __attribute__((always_inline)) explicit Of(T x) : root(1 / std::sqrt(x)), inverse(root * root) {}
    inline __attribute__((always_inline)) T repulsive(T) const {
      const T i2 = inverse * inverse, i4 = i2 * i2;
      return i4 * i4 * inverse * root;
    }
    inline __attribute__((always_inline)) T attractive(T) const {
      const T i2 = inverse * inverse;
      return i2 * i2;
    }
    inline __attribute__((always_inline)) T crossing(T) const {
      const T i2 = inverse * inverse;
      return i2 * i2 * i2 * inverse * root;
    }
  };
};

struct GeneralPowers {
  template <class T>
  struct Of {
    T x, inverse;
    inline __attribute__((always_inline)) explicit Of(T value) : x(value), inverse(1 / value) {}
    inline __attribute__((always_inline)) T repulsive(T alpha) const { return std::pow(x, -alpha); }
    inline __attribute__((always_inline)) T attractive(T beta) const { return std::pow(x, -beta); }
    inline __attribute__((always_inline)) T crossing(T delta) const { return std::pow(x, delta); }
  };
};

// x = cos^2 theta, and dx.
template <class T>
struct BisectorTerms {
  T x, x_p, x_q, x_c;
};

// D and dD.
template <class T>
struct GapTerms {
  T d, d_r, d_p, d_q, d_c;
};

// V and dV/dD.
template <class T>
struct WellTerms {
  T v, v_d;
};

// Gamma W, and its derivatives by r and c.
template <class T>
struct FactorTerms {
  T f, f_r, f_c;
};

struct PaperContact {
  static constexpr const char* law = "paper";  // its name in parameter sets

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

  // U and its derivatives.
  PairTerms<double> terms(double r, double p, double q, double c) const;

  // separation = x_j - x_i; n_i, n_j unit axes.
  PairForce energy_and_gradient(const Vector3& separation, const Vector3& n_i, const Vector3& n_j) const;
  double energy(const Vector3& separation, const Vector3& n_i, const Vector3& n_j) const;

  // The torque of the published force code, which leaves out what comes from theta. Not the gradient of any
  // energy: undamped systems gain energy. For comparison only.
  PairForce legacy_torque(const Vector3& separation, const Vector3& n_i, const Vector3& n_j) const;
};

// The law with another, nearer cutoff (nm, of R); the switch keeps its part of it.
inline PaperContact with_cutoff(PaperContact law, double cutoff) {
  law.switch_start *= cutoff / law.cutoff();
  law.cutoff_ratio = cutoff / law.radius;
  return law;
}

// The law in parts, with its constants in the precision T: plain arithmetic and selections only, so that loops over
// pairs vectorise.
template <class T>
struct PaperTerms {
  T radius, inv_radius, blend, inv_blend;
  T theta[6], theta_x[5];  // coefficients of Theta(z) and of dTheta/dx, z = 2x - 1
  T core_gap, repulsion, attraction, alpha, beta, repulsion2, attraction2;
  T freeze_begin, freeze_end, freeze_blend, inv_freeze, crossing, delta, delta_per_radius;
  T switch_start, inv_switch, switch_slope;

  explicit PaperTerms(const PaperContact& k)
      : radius(T(k.radius)),
        inv_radius(T(1 / k.radius)),
        blend(T(k.bisector_blend)),
        inv_blend(T(1 / k.bisector_blend)),
        core_gap(T(k.core_gap)),
        repulsion(T(4 * k.epsilon * k.repulsion)),
        attraction(T(4 * k.epsilon * k.attraction)),
        alpha(T(k.alpha)),
        beta(T(k.beta)),
        repulsion2(T(k.alpha * (k.alpha + 1))),
        attraction2(T(k.beta * (k.beta + 1))),
        freeze_begin(T(k.freeze - k.freeze_blend)),
        freeze_end(T(k.freeze + k.freeze_blend)),
        freeze_blend(T(k.freeze_blend)),
        inv_freeze(T(0.5 / k.freeze_blend)),
        crossing(T(2 * k.crossing)),
        delta(T(k.delta)),
        delta_per_radius(T(k.delta / k.radius)),
        switch_start(T(k.switch_start)),
        inv_switch(T(1 / (k.cutoff_ratio - k.switch_start))),
        switch_slope(T(-6 / ((k.cutoff_ratio - k.switch_start) * k.radius))) {
    // cos 2 i theta is the Chebyshev polynomial T_i(z).
    const auto& c = k.angular;
    const double a[6] = {1 + c[0] - 2 * c[1] + c[2] + c[4],
                         c[0] - 3 * c[2] + 5 * c[4],
                         2 * c[1] - 8 * c[3],
                         4 * c[2] - 20 * c[4],
                         8 * c[3],
                         16 * c[4]};
    for (int i = 0; i < 6; ++i) theta[i] = T(a[i]);
    for (int i = 0; i < 5; ++i) theta_x[i] = T(2 * (i + 1) * a[i + 1]);
  }

  // Outside of the blend: the one bisector of the axes, the second flipped where they point against each other.
  inline __attribute__((always_inline)) BisectorTerms<T> one_bisector(T p, T q, T c) const {
    const T sign = c < 0 ? T(-1) : T(1);
    const T sum = p + sign * q, inverse = 1 / (2 + 2 * sign * c), x_p = 2 * sum * inverse;
    const T x = sum * sum * inverse;
    return {x, x_p, sign * x_p, -2 * sign * x * inverse};
  }

  // The terms of both bisectors, mixed by the weight w of the first.
  inline __attribute__((always_inline)) BisectorTerms<T> two_bisectors(T p, T q, T c) const {
    const T y = std::min(std::max(c * inv_blend, T(-1)), T(1));
    const T w = T(0.5) + y * (T(0.75) - T(0.25) * y * y);
    const T w_c = T(0.75) * (1 - y * y) * inv_blend;
    const T sum = p + q, dif = p - q;
    // Where a denominator could vanish its weight is zero: the bound only keeps 0 * (0/0) away.
    const T np = std::max(2 + 2 * c, T(1)), nm = std::max(2 - 2 * c, T(1));
    const T both = 1 / (np * nm);
    const T ip = nm * both, im = np * both;
    const T xp = sum * sum * ip, xm = dif * dif * im;
    const T gp = 2 * w * sum * ip, gm = 2 * (1 - w) * dif * im;
    return {w * xp + (1 - w) * xm, gp + gm, gp - gm, w_c * (xp - xm) - 2 * w * xp * ip + 2 * (1 - w) * xm * im};
  }

  // `blended`: some |c| may be below `blend`.
  template <bool blended>
  inline __attribute__((always_inline)) GapTerms<T> gap(T r, T p, T q, T c) const {
    const BisectorTerms<T> b = blended ? two_bisectors(p, q, c) : one_bisector(p, q, c);
    const T *a = theta, *a_x = theta_x;
    const T z = 2 * b.x - 1;
    const T angle = a[0] + z * (a[1] + z * (a[2] + z * (a[3] + z * (a[4] + z * a[5]))));
    const T angle_x = a_x[0] + z * (a_x[1] + z * (a_x[2] + z * (a_x[3] + z * a_x[4])));
    const T d_r = inv_radius / angle, d_2 = r * d_r;  // D + 2
    const T d_x = -d_2 * angle_x * radius * d_r;      // -(D + 2) Theta'/Theta
    return {d_2 - 2, d_r, d_x * b.x_p, d_x * b.x_q, d_x * b.x_c};
  }

  // V; `core`: some D may be below `core_gap`.
  template <class Powers, bool core>
  inline __attribute__((always_inline)) WellTerms<T> well(T d) const {
    const T dv = core ? std::max(d, core_gap) : d;
    const typename Powers::template Of<T> of_d(dv);
    const T rep = repulsion * of_d.repulsive(alpha);
    const T att = attraction * of_d.attractive(beta);
    const T v1 = (beta * att - alpha * rep) * of_d.inverse;
    if (!core) return {rep - att, v1};
    const T v2 = (repulsion2 * rep - attraction2 * att) * of_d.inverse * of_d.inverse;
    const T e = d - dv, bent = e * v2;
    return {rep - att + e * (v1 + T(0.5) * bent), v1 + bent};
  }

  // Gamma, frozen by a smooth maximum, and W.
  template <class Powers>
  inline __attribute__((always_inline)) FactorTerms<T> factor(T r, T c) const {
    const T rho = r * inv_radius;
    const T s = std::min(std::max((rho - freeze_begin) * inv_freeze, T(0)), T(1));
    const T rho_e = std::max(rho, freeze_end) - freeze_blend * (1 - s * s);
    const typename Powers::template Of<T> of_rho(rho_e);
    const T g = crossing * of_rho.crossing(delta);
    const T gs = g * (1 - c * c), gamma = 1 + gs;
    const T gamma_r = gs * delta_per_radius * of_rho.inverse * s;

    const T k = std::min(std::max((rho - switch_start) * inv_switch, T(0)), T(1));
    const T w = 1 - k * k * (3 - 2 * k);
    const T w_r = k * (1 - k) * switch_slope;
    return {gamma * w, gamma_r * w + gamma * w_r, -2 * g * c * w};
  }

  // U and its derivatives.
  template <class Powers>
  PairTerms<T> of(T r, T p, T q, T c) const {
    const GapTerms<T> d = gap<true>(r, p, q, c);
    const WellTerms<T> v = well<Powers, true>(d.d);
    const FactorTerms<T> f = factor<Powers>(r, c);
    const T u_d = f.f * v.v_d, crossing_only = f.f_c * v.v;
    return {f.f * v.v,   u_d * d.d_r + f.f_r * v.v,   u_d * d.d_p,
            u_d * d.d_q, u_d * d.d_c + crossing_only, crossing_only};
  }
};

inline PairTerms<double> PaperContact::terms(double r, double p, double q, double c) const {
  const PaperTerms<double> k(*this);
  return has_published_powers() ? k.of<PublishedPowers>(r, p, q, c) : k.of<GeneralPowers>(r, p, q, c);
}

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

// Energy (eV) of two long rows that cross at `angle`, each at a part of an element from the centre of one.
inline double paper_crossed_energy(const PaperContact& contact, double element_length, double distance,
                                   double angle, double part_i = 0.25, double part_j = 0.25) {
  const Vector3 n_i = Vector3::UnitZ(), n_j(0, std::sin(angle), std::cos(angle));
  const int reach = static_cast<int>(contact.cutoff() / (element_length * std::sin(angle))) + 1;
  double sum = 0;
  for (int k = -reach; k <= reach; ++k)
    for (int l = -reach; l <= reach; ++l)
      sum += contact.energy(
          Vector3(distance, 0, 0) + (l + part_j) * element_length * n_j - (k + part_i) * element_length * n_i, n_i,
          n_j);
  return sum;
}

}  // namespace ropewalk
