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
// The anharmonic bond has the energy per length of anharmonic.hpp, times a, and shear that a bond which is part of
// a circle does not feel:
//
//   stretch, twist, bend   of the strain of the arc  e = D/a (1 + (1 - c)/12) - 1,
//                          of the twist  tau = phi/a  and of the curvature  kappa = delta/a
//   shear                  12 s EI/a (1 - cos psi),  cos psi = (t_i + t_j).d/|t_i + t_j|
//
// with the angles phi and delta themselves, so that its energy does not depend on the length of the elements.
//
// A filament may be curved and twisted at rest, by kappa_0 = (curvature about e1, about e2, twist per length) in its body
// frame. With P = exp(a kappa_0/2), the rotation over half a bond, the harmonic bond acts on the frames R_i P and R_j P^T,
// which are one frame at rest. Forces and torques are vectors in space and need no turning back. A chain at rest is a
// helix of kappa_0 without energy. Where the stiffnesses about e1 and e2 differ, EI is their mean, D = (EI_1 - EI_2)/2, and
//
//   bend   + D/(2a) (w_1^2 - w_2^2),   w = the axial vector of R_i^T R_j     ~ EI_1 delta_1^2/(2a) + EI_2 delta_2^2/(2a)
//   shear  + 6 S/a (n_2^2 - n_1^2),    S = (s_1 EI_1 - s_2 EI_2)/2, n_k = (e_k,i + e_k,j).d/2
//
// in these frames, with s = (s_1 EI_1 + s_2 EI_2)/(2 EI) in the sum above. Each w_k and n_k changes at most its sign where
// the chain is read from its other end.
//
// Units eV, nm. Net force and net torque vanish identically.
// Source: V. A. Kuzkin, I. E. Asonov, Phys. Rev. E 86, 051301 (2012), DOI 10.1103/PhysRevE.86.051301.
#pragma once

#include <Eigen/Geometry>
#include <cmath>

#include "model/anharmonic.hpp"
#include "model/contract.hpp"
#include "model/forms.hpp"
#include "model/units.hpp"

namespace ropewalk {

using Vector3 = Eigen::Vector3d;
inline forms::Vec plain(const Vector3& v) { return {v.x(), v.y(), v.z()}; }
inline Vector3 vector(const forms::Vec& v) { return {v.x, v.y, v.z}; }

using forms::BondShape;
using forms::BondStiffness;

// s of a bond of length a that bends alike in all directions.
inline double even_shear_share(const BondStiffness& k, double a) {
  return k.shear > 0 ? 1 / (1 + 12 * k.bend / (k.shear * a * a)) : 1.0;
}

// Whether a bond has a natural shape or two stiffnesses of bending.
inline bool is_shaped(const BondStiffness& k) {
  return k.bend_difference != 0 || k.natural.x != 0 || k.natural.y != 0 || k.natural.z != 0;
}

// The largest rotation of a natural shape over one bond: beyond it, elements no longer follow the shape.
inline constexpr double most_natural_turn = 0.5 * units::pi;

// The same bond, straight at rest and as stiff in all directions as in the mean.
inline BondStiffness straightened(BondStiffness k) {
  k.bend_difference = 0;
  k.natural = {};
  return k;
}

inline BondShape bond_shape(const BondStiffness& k, double a) {
  BondStiffness one = k, two = k;
  one.bend += k.bend_difference;
  two.bend -= k.bend_difference;
  const double first = one.bend * even_shear_share(one, a), second = two.bend * even_shear_share(two, a);
  const Vector3 turn = 0.5 * a * vector(k.natural);
  const double angle = turn.norm();
  Eigen::Matrix3d p = Eigen::Matrix3d::Identity();
  if (angle > 0) p = Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix();
  return {is_shaped(k),
          k.bend_difference == 0 ? even_shear_share(k, a) : 0.5 * (first + second) / k.bend,
          0.5 * (first - second),
          {plain(p.col(0)), plain(p.col(1)), plain(p.col(2))}};
}

// s of a bond of length a, in the mean of both directions.
inline double shear_share(const BondStiffness& k, double a) {
  return k.bend_difference == 0 ? even_shear_share(k, a) : bond_shape(k, a).share;
}

// kGA of a thin tube: GA = GJ/r^2, k = 2 (1 + nu)/(4 + 3 nu) with Poisson's ratio from EA r^2/GJ = 2 (1 + nu).
// G. R. Cowper, J. Appl. Mech. 33, 335 (1966), DOI 10.1115/1.3625046.
inline double thin_tube_shear(const BondStiffness& k, double radius) {
  const double nu = 0.5 * k.stretch * radius * radius / k.twist - 1;
  return 2 * (1 + nu) / (4 + 3 * nu) * k.twist / (radius * radius);
}

// Body frame of an element: e1 and e2 span the cross-section, t is the tube axis (local z).
struct Frame {
  Vector3 e1, e2, t;
};
inline forms::BodyFrame plain(const Frame& f) { return {plain(f.e1), plain(f.e2), plain(f.t)}; }

struct BondEnergy {
  double stretch = 0, shear = 0, bend = 0, twist = 0;  // eV
  double total() const { return stretch + shear + bend + twist; }
};

struct BondForce {
  BondEnergy energy;
  Vector3 force_j;             // force on element j; element i feels the opposite
  Vector3 torque_i, torque_j;  // about the element centres
};

// Twist angle of a bond in (-pi, pi], positive when frame j is turned against frame i by the right-hand rule
// about the common axis; a bend of the axis does not enter.
inline double bond_twist_angle(const forms::BodyFrame& i, const forms::BodyFrame& j) {
  return std::atan2(forms::twist_sine(i, j), forms::twist_cosine(i, j));
}
inline double bond_twist_angle(const Frame& i, const Frame& j) { return bond_twist_angle(plain(i), plain(j)); }

// The frames of both elements, each turned by half of the natural rotation towards the other: R_i P and R_j P^T. Twist and
// bend of a bond are those of these frames, and count from its natural shape.
struct BondEnds {
  Frame i, j;
};
inline BondEnds bond_ends(const BondStiffness& k, double a, const Frame& i, const Frame& j) {
  if (!is_shaped(k)) return {i, j};
  const forms::BodyFrame turn = bond_shape(k, a).turn, fi = forms::frame_turned(plain(i), turn),
                         fj = forms::frame_turned_back(plain(j), turn);
  return {{vector(fi.e1), vector(fi.e2), vector(fi.t)}, {vector(fj.e1), vector(fj.e2), vector(fj.t)}};
}
inline double bond_twist_angle(const BondStiffness& k, double a, const Frame& i, const Frame& j) {
  const BondEnds ends = bond_ends(k, a, i, j);
  return bond_twist_angle(ends.i, ends.j);
}

inline BondForce bond_energy_and_gradient(const BondStiffness& k, double a, const Vector3& separation,
                                          const Frame& i, const Frame& j) {
  const forms::Vec r = plain(separation);
  forms::BondAction f;
  if (is_shaped(k)) {
    ROPEWALK_EXPECTS(!k.anharmonic.used);
    const BondShape shape = bond_shape(k, a);
    f = forms::shaped_bond(&k, shape.share, shape.shear_difference, a, r, forms::frame_turned(plain(i), shape.turn),
                           forms::frame_turned_back(plain(j), shape.turn));
  } else {
    const forms::BodyFrame fi = plain(i), fj = plain(j);
    const double share = even_shear_share(k, a);
    f = k.anharmonic.used ? forms::anharmonic_bond(&k, share, a, r, fi, fj, bond_twist_angle(fi, fj))
                          : forms::harmonic_bond(&k, share, a, r, fi, fj);
  }
  return {{f.energy.stretch, f.energy.shear, f.energy.bend, f.energy.twist},
          vector(f.force_j),
          vector(f.torque_i),
          vector(f.torque_j)};
}

inline BondEnergy bond_energy(const BondStiffness& k, double a, const Vector3& separation, const Frame& i,
                              const Frame& j) {
  return bond_energy_and_gradient(k, a, separation, i, j).energy;
}

// The harmonic bond that is as stiff as an anharmonic one anywhere on the edges of its window, where it is
// stiffest: each of its stiffnesses is a polynomial of second degree.
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
  const double share = shear_share(k, a);
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
