// Energy of a tube per length beyond Hooke's law, as the atoms have it before the wall kinks, collapses or buckles:
//
//   W(e, tau, kappa) = EA/2 e^2 + GJ/2 tau^2 + EI/2 kappa^2
//                    + C e tau + sum over 3 <= i + j <= 4 of c_ij e^i s^j + c_b b^4
//
// with the strain e of the axis, the twist tau and the curvature kappa (per length of the relaxed tube), and with
// the wall's shear s = r tau and bending strain b = r kappa, so that all c are forces. C and the odd powers of s are
// zero but for chiral tubes. The quartic term of bending is the flattening of the cross-section (L. G. Brazier,
// Proc. R. Soc. A 116, 104 (1927), DOI 10.1098/rspa.1927.0125).
//
// Beyond the window the wall has collapsed into a ribbon or has kinked. The torque and the moment then stay at their
// values at the edge, as those of the atoms do within some per cent and within a third; the energy of twist goes on as
// the tangent in s, that of bending as the tangent in b, and it no longer depends on where the twist or the bend is
// concentrated. The terms with a strain go on as the tangent in e and in s, beside EA/2 e^2. Forces stay continuous.
// Units eV, nm, rad.
#pragma once

#include <algorithm>
#include <cmath>

namespace ropewalk {

struct Anharmonic {
  bool used = false;    // false: the bond is harmonic
  double radius = 0;    // nm
  double coupling = 0;  // C, eV
  double e3 = 0, e2s = 0, es2 = 0, s3 = 0, e4 = 0, e3s = 0, e2s2 = 0, es3 = 0, s4 = 0;  // c_ij, eV/nm
  double b4 = 0;                                                                        // c_b, eV/nm
  double min_strain = 0, max_strain = 0, max_shear = 0, max_bend = 0;                   // the window of e, |s|, b
};

// The terms that are fitted, by the names that they have in a parameter set.
struct AnharmonicTerm {
  const char* key;
  double Anharmonic::*value;
  const char* meaning;
};
inline constexpr AnharmonicTerm anharmonic_terms[] = {
    {"e3", &Anharmonic::e3, "of strain^3"},
    {"e2s", &Anharmonic::e2s, "of strain^2 shear"},
    {"es2", &Anharmonic::es2, "of strain shear^2"},
    {"s3", &Anharmonic::s3, "of shear^3"},
    {"e4", &Anharmonic::e4, "of strain^4"},
    {"e3s", &Anharmonic::e3s, "of strain^3 shear"},
    {"e2s2", &Anharmonic::e2s2, "of strain^2 shear^2"},
    {"es3", &Anharmonic::es3, "of strain shear^3"},
    {"s4", &Anharmonic::s4, "of shear^4"},
    {"b4", &Anharmonic::b4, "of (radius times curvature)^4"}};

// Energies per length (eV/nm) with their derivatives by strain, by twist and by the square of the curvature.
template <class T>
struct TwistEnergy {
  T energy, by_twist;
};

// The energy of twist alone; GJ is the harmonic stiffness (eV nm).
template <class T>
TwistEnergy<T> twist_energy(const Anharmonic& h, double GJ, T twist) {
  const double g = GJ / (h.radius * h.radius);
  const T shear = h.radius * twist, s = std::min(std::max(shear, -h.max_shear), h.max_shear);
  const T slope = s * (g + s * (3 * h.s3 + 4 * s * h.s4));
  return {s * s * (0.5 * g + s * (h.s3 + s * h.s4)) + slope * (shear - s), h.radius * slope};
}

// The energy that strain adds to EA/2 e^2 and to the energy of twist.
template <class T>
struct StrainEnergy {
  T energy, by_strain, by_twist;
};

template <class T>
StrainEnergy<T> strain_energy(const Anharmonic& h, T strain, T twist) {
  const T shear = h.radius * twist;
  const T e = std::min(std::max(strain, h.min_strain), h.max_strain);
  const T s = std::min(std::max(shear, -h.max_shear), h.max_shear);
  // Coefficients of e, e^2 and e^3, and their derivatives by s.
  const T a1 = s * s * (h.es2 + s * h.es3), a1s = s * (2 * h.es2 + 3 * s * h.es3);
  const T a2 = s * (h.e2s + s * h.e2s2), a2s = h.e2s + 2 * s * h.e2s2;
  const T a3 = h.e3 + s * h.e3s;
  const T w = e * (a1 + e * (a2 + e * (a3 + e * h.e4)));
  const T we = a1 + e * (2 * a2 + e * (3 * a3 + e * 4 * h.e4));
  const T ws = e * (a1s + e * (a2s + e * h.e3s)), wes = a1s + e * (2 * a2s + e * 3 * h.e3s);
  const T de = strain - e, ds = shear - s;
  return {w + we * de + (ws + wes * de) * ds + h.coupling * strain * twist, we + wes * ds + h.coupling * twist,
          h.radius * (ws + wes * de) + h.coupling * strain};
}

template <class T>
struct BendEnergy {
  T energy, by_curvature2;
};

// EI is the harmonic stiffness (eV nm).
template <class T>
BendEnergy<T> bend_energy(const Anharmonic& h, double EI, T curvature2) {
  using std::sqrt;
  const double r2 = h.radius * h.radius, edge = h.max_bend * h.max_bend / r2, quartic = h.b4 * r2 * r2;
  const T inside = std::min(curvature2, T(edge)), outside = std::max(curvature2, T(edge));
  const T slope = 0.5 * EI + 2 * quartic * inside, on_edge = sqrt(edge / outside);
  return {inside * (0.5 * EI + quartic * inside) + 2 * slope * (outside * on_edge - edge), slope * on_edge};
}

}  // namespace ropewalk
