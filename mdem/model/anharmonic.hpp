// Energy of a tube per length beyond Hooke's law, as the atoms have it before the wall kinks, collapses or buckles:
//
//   W(e, tau, kappa) = EA/2 e^2 + GJ/2 tau^2 + EI/2 kappa^2
//                    + C e tau + sum over 3 <= i + j <= 4 of c_ij e^i s^j + c_b b^4
//
// with the strain e of the axis, the twist tau and the curvature kappa (per length of the relaxed tube), and with
// the wall's shear s = r tau and bending strain b = r kappa, so that all c are forces. C and the odd powers of s
// are zero but for chiral tubes. The quartic term of bending is the flattening of the cross-section (L. G. Brazier,
// Proc. R. Soc. A 116, 104 (1927), DOI 10.1098/rspa.1927.0125).
//
// Beyond the window the wall has collapsed into a ribbon or has kinked. The torque and the moment then stay at
// their values at the edge, as those of the atoms do within some per cent and within a third; the energy of twist
// goes on as the tangent in s, that of bending as the tangent in b, and it no longer depends on where the twist or
// the bend is concentrated. The terms with a strain go on as the tangent in e and in s, beside EA/2 e^2. Forces
// stay continuous.
//
// A tube without twist that is stretched beyond the window has the force of the pull:
//
//   dW/de = F_k + t (h m_k + t (3 R - 2 h m_k - h m_k+1 + t (h m_k + h m_k+1 - 2 R))),   R = F_k+1 - F_k,
//
// with t = 0 .. 1 between strains h apart. F_0 and m_0 are force and slope at the edge of the window, the other F_k
// are forces of atoms, and the slopes m_k are those of F. N. Fritsch and R. E. Carlson (SIAM J. Numer. Anal. 17,
// 238 (1980), DOI 10.1137/0717021): the force rises where the table rises. Beyond the table the force stays. Where
// no pull is known the force goes on along its tangent at the edge. On the side of compression it goes on with the
// slope EA, which is less than that at the edge. Units eV, nm, rad.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "model/forms.hpp"

namespace ropewalk {

using forms::Anharmonic;

// The terms that are fitted, by the names that they have in a parameter set.
struct AnharmonicTerm {
  const char* key;
  double Anharmonic::*value;
  const char* meaning;
};
inline constexpr AnharmonicTerm anharmonic_terms[] = {{"e3", &Anharmonic::e3, "of strain^3"},
                                                      {"e2s", &Anharmonic::e2s, "of strain^2 shear"},
                                                      {"es2", &Anharmonic::es2, "of strain shear^2"},
                                                      {"s3", &Anharmonic::s3, "of shear^3"},
                                                      {"e4", &Anharmonic::e4, "of strain^4"},
                                                      {"e3s", &Anharmonic::e3s, "of strain^3 shear"},
                                                      {"e2s2", &Anharmonic::e2s2, "of strain^2 shear^2"},
                                                      {"es3", &Anharmonic::es3, "of strain shear^3"},
                                                      {"s4", &Anharmonic::s4, "of shear^4"},
                                                      {"b4", &Anharmonic::b4, "of (radius times curvature)^4"}};

// Energies per length (eV/nm) with their derivatives by strain, by twist and by the square of the curvature: of
// twist alone, what strain adds to EA/2 e^2 and to the energy of twist, and of bending. GJ, EI: harmonic stiffness
// (eV nm).
inline forms::TwistEnergy twist_energy(const Anharmonic& h, double GJ, double twist) {
  return forms::twist_energy(&h, GJ, twist);
}
inline forms::StrainEnergy strain_energy(const Anharmonic& h, double strain, double twist) {
  return forms::strain_energy(&h, strain, twist);
}
inline forms::BendEnergy bend_energy(const Anharmonic& h, double EI, double curvature2) {
  return forms::bend_energy(&h, EI, curvature2);
}

// Beyond the window, beside EA/2 e^2 and strain_energy(). EA: eV/nm.
inline forms::StretchEnergy stretch_beyond(const Anharmonic& h, double EA, double strain) {
  return forms::stretch_beyond(&h, EA, strain);
}

// Force of stretch and its slope at the upper edge of the window of a tube without twist (eV/nm).
struct EdgeOfWindow {
  double force = 0, slope = 0;
};
inline EdgeOfWindow edge_of_window(const Anharmonic& h, double EA) {
  return {EA * h.max_strain + strain_energy(h, h.max_strain, 0).by_strain, EA + forms::slope_at_edge(&h)};
}

// Forces (eV/nm) of a tube without twist that is pulled, at equal steps of strain from the edge of the window to
// `end`.
struct Pull {
  double end = 0;
  std::array<double, PULL_STEPS + 1> force{};
  double edge_force = 0;  // at the edge of the window when the pull was made; 0: as it is
};
// The forces that a bond has: the first is that of the window. All others are scaled as the edge of the window has
// been since the pull was made, so that a tube with another EA keeps the shape of its pull.
inline std::array<double, PULL_STEPS + 1> forces_of(const Pull& pull, const Anharmonic& h, double EA) {
  const double edge = edge_of_window(h, EA).force;
  double scale = pull.edge_force > 0 ? edge / pull.edge_force : 1;
  if (std::fabs(scale - 1) < 1e-12) scale = 1;  // rounding of the file
  std::array<double, PULL_STEPS + 1> out = pull.force;
  for (double& force : out) force *= scale;
  out[0] = edge;
  return out;
}
inline void set_pull(Anharmonic& h, double EA, const Pull& pull) {
  const double step = h.pull_step = (pull.end - h.max_strain) / PULL_STEPS;
  const EdgeOfWindow edge = edge_of_window(h, EA);
  std::array<double, PULL_STEPS + 1> force = forces_of(pull, h, EA), slope{};
  const auto secant = [&](int k) { return (force[k + 1] - force[k]) / step; };
  slope[0] = edge.slope;
  for (int k = 1; k < PULL_STEPS; ++k) {
    const double before = secant(k - 1), behind = secant(k);
    slope[k] = before > 0 && behind > 0 ? 2 * before * behind / (before + behind) : 0;
  }
  const double last = secant(PULL_STEPS - 1);
  slope[PULL_STEPS] = std::clamp(1.5 * last - 0.5 * secant(PULL_STEPS - 2), 0.0, std::max(0.0, 3 * last));
  const double tangent = edge.force - EA * h.max_strain;  // what the terms beside EA/2 e^2 go on with
  for (int k = 0; k <= PULL_STEPS; ++k) {
    h.pull_force[k] = force[k] - EA * (h.max_strain + k * step) - tangent;
    h.pull_slope[k] = slope[k] - EA;
    if (k > 0)
      h.pull_energy[k] = h.pull_energy[k - 1] + step * (0.5 * (h.pull_force[k - 1] + h.pull_force[k]) +
                                                        step * (h.pull_slope[k - 1] - h.pull_slope[k]) / 12);
  }
  h.pull_force[0] = h.pull_energy[0] = 0;
}

// The largest strain that has the force of atoms.
inline double end_of_stretch(const Anharmonic& h) { return h.max_strain + PULL_STEPS * h.pull_step; }

}  // namespace ropewalk
