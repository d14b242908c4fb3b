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
// stay continuous. Units eV, nm, rad.
#pragma once

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

}  // namespace ropewalk
