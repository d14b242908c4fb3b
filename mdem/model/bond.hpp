// Elastic bond between consecutive elements of a tube: the vector-based (V-) model.
//
// With a the equilibrium length, r = x_j - x_i, D = |r|, d = r/D, orthonormal body frames (e1, e2, t) where t
// is the tube axis, c = t_i.t_j and w = e1_i.e1_j + e2_i.e2_j, the energy is the sum of four parts that are
// each zero at rest and each have a plain meaning:
//
//   stretch  EA/(2a) (D - a)^2
//   bend     EI/a (1 - c)                                            ~ EI delta^2/(2a), delta = angle(t_i, t_j)
//   shear    s [12 EI/a (1 - (t_i + t_j).d/2) - 3 EI/a (1 - c)]      ~ 6 s EI/a psi^2, psi = mean angle to d
//   twist    GJ/(2a) (1 + c - w) = GJ/(2a) (1 + c)(1 - cos phi)      ~ GJ phi^2/(2a)
//
// Their sum is Kuzkin and Asonov's
//   B1/2 (D-a)^2 - B2/2 (t_i + t_j).d - B3 t_i.t_j - B4/2 w + const,
//   B1 = EA/a, B2 = 12 s EI/a, B3 = (1 - 3 s) EI/a - GJ/(2a), B4 = GJ/a,
// which with s = 1 has the stretching, bending and torsional stiffness of an Euler-Bernoulli beam. Tubes whose
// shape changes within a few diameters also shear: with
//   s = 1/(1 + 12 EI/(kGA a^2)),    kGA the shear stiffness,
// the bond is the exact element of a Timoshenko beam. It is a total energy, so nothing drifts with the path.
// Limits: the torque of twist peaks at phi = 90 degrees and is zero at 180; beyond the peak a bond slips, and the
// simulator stops before it does.
//
// The anharmonic bond has the energy per length of anharmonic.hpp, times a, and shear that a bond which is part of a
// circle does not feel:
//
//   stretch, twist, bend   of the strain of the arc  e = D/a (1 + (1 - c)/12) - 1,
//                          of the twist  tau = phi/a  and of the curvature  kappa = delta/a
//   shear                  12 s EI/a (1 - cos psi),  cos psi = (t_i + t_j).d/|t_i + t_j|
//
// with the angles phi and delta themselves, so that its energy does not depend on the length of the elements.
//
// Units eV, nm. Net force and net torque vanish identically.
// Source: V. A. Kuzkin, I. E. Asonov, Phys. Rev. E 86, 051301 (2012), DOI 10.1103/PhysRevE.86.051301.
#pragma once

#include <Eigen/Geometry>
#include <cmath>

#include "model/anharmonic.hpp"
#include "model/units.hpp"

namespace ropewalk {

template <class T>
using Vec3 = Eigen::Matrix<T, 3, 1>;
using Vector3 = Vec3<double>;

struct BondStiffness {
  double stretch = 0;  // EA, eV/nm
  double bend = 0;     // EI, eV nm
  double twist = 0;    // GJ, eV nm
  double shear = 0;    // kGA, eV/nm; 0: rigid in shear, as in the published model
  Anharmonic anharmonic = {};

  // s of a bond of length a.
  double shear_share(double a) const { return shear > 0 ? 1 / (1 + 12 * bend / (shear * a * a)) : 1.0; }
};

// kGA of a thin tube: GA = GJ/r^2, k = 2 (1 + nu)/(4 + 3 nu) with Poisson's ratio from EA r^2/GJ = 2 (1 + nu).
// G. R. Cowper, J. Appl. Mech. 33, 335 (1966), DOI 10.1115/1.3625046.
inline double thin_tube_shear(const BondStiffness& k, double radius) {
  const double nu = 0.5 * k.stretch * radius * radius / k.twist - 1;
  return 2 * (1 + nu) / (4 + 3 * nu) * k.twist / (radius * radius);
}

// Body frame of an element: e1 and e2 span the cross-section, t is the tube axis (local z). V: the vectors, Eigen's
// or plain ones (sim/state/plain_vector.hpp), whose loops the compiler vectorises.
template <class T, class V = Vec3<T>>
struct Frame {
  using Vector = V;
  V e1, e2, t;
};

template <class T>
struct BondEnergy {
  T stretch{0}, shear{0}, bend{0}, twist{0};
  T total() const { return stretch + shear + bend + twist; }
};

template <class T, class V = Vec3<T>>
struct BondForce {
  BondEnergy<T> energy;
  V force_j;             // on element j; element i feels the opposite
  V torque_i, torque_j;  // about the element centres
};

// The bond of BondStiffness without its anharmonic part.
template <class T, class V>
BondEnergy<T> harmonic_energy(const BondStiffness& k, double a, const typename Frame<T, V>::Vector& separation,
                          const Frame<T, V>& i, const Frame<T, V>& j) {
  using std::sqrt;
  const T length = sqrt(separation.dot(separation));
  const V d = separation / length;
  const T stretch = length - a;
  // 1 - u.v is written as |u - v|^2/2 so that small bends do not drown in rounding.
  const T one_minus_c = (i.t - j.t).squaredNorm() * 0.5;
  const T one_minus_td = ((i.t - d).squaredNorm() + (j.t - d).squaredNorm()) * 0.25;
  const T frame_misfit = ((i.e1 - j.e1).squaredNorm() + (i.e2 - j.e2).squaredNorm()) * 0.5;  // 2 - w
  BondEnergy<T> e;
  e.stretch = 0.5 * k.stretch / a * stretch * stretch;
  e.bend = k.bend / a * one_minus_c;
  e.shear = k.shear_share(a) * k.bend / a * (12.0 * one_minus_td - 3.0 * one_minus_c);
  e.twist = 0.5 * k.twist / a * (frame_misfit - one_minus_c);
  return e;
}

template <class T, class V>
BondForce<T, V> harmonic_force(const BondStiffness& k, double a,
                                         const typename Frame<T, V>::Vector& separation, const Frame<T, V>& i,
                                         const Frame<T, V>& j) {
  using std::sqrt;
  const T length = sqrt(separation.dot(separation));
  const V d = separation / length;
  const double share = k.shear_share(a);
  const double b2 = 12.0 * share * k.bend / a;
  const double b3 = (1.0 - 3.0 * share) * k.bend / a - 0.5 * k.twist / a;
  const double b4 = k.twist / a;

  BondForce<T, V> out;
  out.energy = harmonic_energy(k, a, separation, i, j);
  const V s = i.t + j.t;
  out.force_j = -(k.stretch / a) * (length - a) * d + (0.5 * b2 / length) * (s - s.dot(d) * d);
  // For a body vector u with g = dU/du the torque is g x u.
  const V frames = (0.5 * b4) * (i.e1.cross(j.e1) + i.e2.cross(j.e2)) + b3 * i.t.cross(j.t);
  out.torque_i = -(0.5 * b2) * d.cross(i.t) + frames;
  out.torque_j = -(0.5 * b2) * d.cross(j.t) - frames;
  return out;
}

// Twist angle of a bond in (-pi, pi], positive when frame j is turned against frame i by the right-hand rule
// about the common axis; a bend of the axis does not enter.
template <class T, class V>
T bond_twist_angle(const Frame<T, V>& i, const Frame<T, V>& j) {
  using std::atan2;
  return atan2(i.e2.dot(j.e1) - i.e1.dot(j.e2), i.e1.dot(j.e1) + i.e2.dot(j.e2));
}

// delta^2 of cos delta = 1 - u, and its derivative: the series of arccos(1 - u)^2, within 3e-3 at 90 degrees and 1e-6
// at 40.
template <class T>
T squared_angle(T u) {
  return 2.0 * u * (1.0 + u * (1.0 / 6 + u * (2.0 / 45 + u * (1.0 / 70 + u * (8.0 / 1575)))));
}
template <class T>
T squared_angle_slope(T u) {
  return 2.0 * (1.0 + u * (2.0 / 6 + u * (6.0 / 45 + u * (4.0 / 70 + u * (40.0 / 1575)))));
}

template <class T, class V>
BondForce<T, V> anharmonic_force(const BondStiffness& k, double a, const typename Frame<T, V>::Vector& separation,
                                 const Frame<T, V>& i, const Frame<T, V>& j) {
  using std::sqrt;
  const T length = sqrt(separation.dot(separation));
  const V d = separation / length;
  const T u = (i.t - j.t).squaredNorm() * 0.5;
  const T arc = 1.0 + u * (1.0 / 12);
  const T strain = length * arc / a - 1.0, twist = bond_twist_angle(i, j) / a;
  const T curvature2 = squared_angle(u) / (a * a);
  const TwistEnergy<T> of_twist = twist_energy(k.anharmonic, k.twist, twist);
  const StrainEnergy<T> of_strain = strain_energy(k.anharmonic, strain, twist);
  const BendEnergy<T> of_bend = bend_energy(k.anharmonic, k.bend, curvature2);
  const V sum = i.t + j.t;
  const T sum_norm = sqrt(sum.dot(sum));
  const V along = sum / sum_norm;
  const T cos_psi = along.dot(d);
  const double shear = 12.0 * k.shear_share(a) * k.bend / a;

  // Derivatives of the energy: by the strain over the length, by the angle of twist, and by u.
  const T pull = k.stretch * strain + of_strain.by_strain, moment = of_twist.by_twist + of_strain.by_twist;
  const T by_u = of_bend.by_curvature2 * squared_angle_slope(u) / a + pull * length * (1.0 / 12);

  BondForce<T, V> out;
  out.energy.stretch = a * (0.5 * k.stretch * strain * strain + of_strain.energy);
  out.energy.twist = a * of_twist.energy;
  out.energy.bend = a * of_bend.energy;
  out.energy.shear = 0.5 * shear * (along - d).squaredNorm();
  out.force_j = (shear / length) * (along - cos_psi * d) - pull * arc * d;
  const V bending = by_u * i.t.cross(j.t) + (moment / (2.0 - u)) * sum;
  const V lean = (shear / sum_norm) * (d - cos_psi * along);
  out.torque_i = bending - lean.cross(i.t);
  out.torque_j = -bending - lean.cross(j.t);
  return out;
}

template <class T, class V>
BondForce<T, V> bond_energy_and_gradient(const BondStiffness& k, double a,
                                         const typename Frame<T, V>::Vector& separation, const Frame<T, V>& i,
                                         const Frame<T, V>& j) {
  return k.anharmonic.used ? anharmonic_force(k, a, separation, i, j) : harmonic_force(k, a, separation, i, j);
}

template <class T, class V>
BondEnergy<T> bond_energy(const BondStiffness& k, double a, const typename Frame<T, V>::Vector& separation,
                          const Frame<T, V>& i, const Frame<T, V>& j) {
  return k.anharmonic.used ? anharmonic_force(k, a, separation, i, j).energy
                           : harmonic_energy(k, a, separation, i, j);
}

// The harmonic bond that is as stiff as an anharmonic one anywhere on the edges of its window, where it is stiffest:
// each of its stiffnesses is a polynomial of second degree.
inline BondStiffness stiffest_in_window(const BondStiffness& k) {
  const Anharmonic& h = k.anharmonic;
  BondStiffness out = k;
  out.anharmonic = {};
  if (!h.used) return out;
  const double r2 = h.radius * h.radius;
  for (const double e : {h.min_strain, h.max_strain})
    for (const double s : {-h.max_shear, 0.0, h.max_shear}) {
      out.stretch = std::fmax(out.stretch, k.stretch + 6 * h.e3 * e + 12 * h.e4 * e * e + 2 * s * h.e2s +
                                               6 * e * s * h.e3s + 2 * s * s * h.e2s2);
      out.twist = std::fmax(out.twist, k.twist + r2 * (2 * e * h.es2 + 2 * e * e * h.e2s2 + 6 * s * h.s3 +
                                                       6 * e * s * h.es3 + 12 * s * s * h.s4));
    }
  out.bend = std::fmax(k.bend, k.bend + 12 * h.b4 * r2 * h.max_bend * h.max_bend);
  return out;
}

// Entries, over the masses, of the stiffness matrix of an infinite straight chain for deflections u and rotations
// phi of wave number q (1/element); the coupling is made symmetric by the masses.
struct ChainMode {
  double uu = 0, pp = 0, up = 0;
};
inline ChainMode chain_mode(const BondStiffness& k, double q, double a, double mass, double inertia) {
  const double share = k.shear_share(a);
  return {24.0 * share * k.bend / (a * a * a) * (1.0 - std::cos(q)) / mass,
          k.bend / a * (2.0 - 2.0 * std::cos(q) + 6.0 * share * (1.0 + std::cos(q))) / inertia,
          12.0 * share * k.bend / (a * a) * std::sin(q) / std::sqrt(mass * inertia)};
}

// Largest angular frequency (rad/ps) of an infinite straight chain of such bonds. mass in eV ps^2/nm^2, isotropic
// inertia in eV ps^2. Sideways: the coupled deflection-rotation branch, searched over the wave vector.
inline double stiffest_sideways_frequency(const BondStiffness& k, double a, double mass, double inertia) {
  double largest = 0;
  for (int step = 0; step <= 256; ++step) {
    const ChainMode m = chain_mode(k, units::pi * step / 256.0, a, mass, inertia);
    largest =
        std::fmax(largest, 0.5 * (m.uu + m.pp) + std::sqrt(0.25 * (m.uu - m.pp) * (m.uu - m.pp) + m.up * m.up));
  }
  return std::sqrt(largest);
}

// The stiffest of all branches: sideways, and longitudinal and torsional at the zone boundary. 1/ps.
inline double stiffest_chain_frequency(const BondStiffness& k, double a, double mass, double inertia) {
  const double along = std::sqrt(std::fmax(4.0 * k.stretch / (a * mass), 4.0 * k.twist / (a * inertia)));
  return std::fmax(along, stiffest_sideways_frequency(k, a, mass, inertia));
}

}  // namespace ropewalk
