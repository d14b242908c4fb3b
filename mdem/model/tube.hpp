// Geometry of a single-walled carbon nanotube (n,m), unrelaxed (rolled graphene).
//
//   C = a sqrt(n^2 + n m + m^2)   circumference, nm        r = C / 2 pi
//   atoms per length = 4 C / (sqrt(3) a^2)                 two atoms per hexagon of area sqrt(3) a^2 / 2
//   T = sqrt(3) C / gcd(2n + m, 2m + n)                    translational period, nm
//
// with the graphene lattice constant a = 0.246 nm. Relaxed tubes differ by up to 2 %: a calibrated
// parameter set carries the relaxed values. Source: Saito, Dresselhaus, Dresselhaus, Physical Properties of
// Carbon Nanotubes (1998), DOI 10.1142/p080.
#pragma once

#include <cmath>
#include <numeric>

#include "model/units.hpp"

namespace ropewalk {

inline constexpr double graphene_lattice_constant = 0.246;  // nm

struct Chirality {
  int n = 10;
  int m = 10;

  // (m,n) is the mirror image of (n,m).
  bool valid() const { return n >= 0 && m >= 0 && n + m >= 1; }
  // Tubes (n,n) and (n,0) are their own mirror images.
  bool chiral() const { return n > 0 && m > 0 && n != m; }
};

inline double circumference(Chirality c, double a = graphene_lattice_constant) {
  return a * std::sqrt(static_cast<double>(c.n) * c.n + static_cast<double>(c.n) * c.m +
                       static_cast<double>(c.m) * c.m);
}

inline double tube_radius(Chirality c, double a = graphene_lattice_constant) {
  return circumference(c, a) / (2.0 * units::pi);
}

inline double atoms_per_length(Chirality c, double a = graphene_lattice_constant) {
  return 4.0 * circumference(c, a) / (std::sqrt(3.0) * a * a);
}

inline double translational_period(Chirality c, double a = graphene_lattice_constant) {
  return std::sqrt(3.0) * circumference(c, a) / std::gcd(2 * c.n + c.m, 2 * c.m + c.n);
}

inline double chiral_angle(Chirality c) {  // rad, 0 zigzag .. pi/6 armchair; beyond that, mirror images
  return std::atan2(std::sqrt(3.0) * c.m, 2.0 * c.n + c.m);
}

}  // namespace ropewalk
