// van der Waals energy of two straight tubes, each a continuous cylindrical shell of atoms.
//
//   atoms      v(d) = 4 eps [(sigma/d)^12 - (sigma/d)^6],  d < cutoff  (truncated, not shifted, as lj/cut does)
//   parallel   E(R) = n_i n_j r_i r_j  int dphi_i int dphi_j int dz  v(d)               eV per nm of length
//   crossed    E(R, gamma) = n_i n_j r_i r_j  int int int int  v(d)                     eV, all of both tubes
//
// with n the atoms per area. Both equal, exactly, line integrals of one isotropic density u(rho) between the axes:
//
//   E(R) = int u(sqrt(R^2 + t^2)) dt,   E(R, gamma) = 1/sin(gamma) 2 pi int_R^inf u(rho) rho drho,
//   u(rho) = -(1/pi) int_0^inf E'(R)/R dt,  R = sqrt(rho^2 + t^2)          (Abel inverse)
//
// because the two-dimensional Fourier transform of the shell-shell kernel factorises.
// Units eV, nm.
// Sources: L. A. Girifalco, M. Hodak, R. S. Lee, Phys. Rev. B 62, 13104 (2000), DOI 10.1103/PhysRevB.62.13104;
// A. N. Volkov, L. V. Zhigilei, J. Phys. Chem. C 114, 5513 (2010), DOI 10.1021/jp906142h.
#pragma once

#include <array>
#include <limits>
#include <string>
#include <vector>

#include "model/bond.hpp"

namespace ropewalk::calibrate {

inline constexpr double infinite = std::numeric_limits<double>::infinity();

// Lennard-Jones between two atoms.
struct AtomLaw {
  double epsilon = 2.84e-3;  // eV
  double sigma = 0.34;       // nm
  double cutoff = 1.2;       // nm; infinity: none

  double energy(double distance) const;
};

struct Shell {
  double radius = 0;   // nm
  double density = 0;  // atoms per nm^2
};

// Two atoms per hexagon of a sheet of lattice constant a.
double graphene_density(double a);

// Adaptive quadrature (GSL) finds these to 1e-7 of the well or better. `distance` is that of the axes and must
// exceed r_i + r_j.
double parallel_energy(const AtomLaw& law, const Shell& i, const Shell& j, double distance);             // eV/nm
double parallel_energy_derivative(const AtomLaw& law, const Shell& i, const Shell& j, double distance);  // eV/nm^2
// The fourfold integral, without use of the line density. 0 < angle <= pi/2.
double crossed_energy(const AtomLaw& law, const Shell& i, const Shell& j, double distance, double angle);  // eV

// The line density by Abel inversion of the parallel energy, eV/nm^2.
double line_density(const AtomLaw& law, const Shell& i, const Shell& j, double rho);

// Sum over the atoms of two finite or periodic cells, for checks: energy per length (eV/nm) of tube j, moved to
// (distance, 0, shift) and turned by `turn` about its axis, beside tube i. Both cells are repeated as far as the
// cutoff (which must be finite) reaches; per length of cell i, whose period cell j may not share.
struct AtomColumn {
  std::vector<Vector3> atoms;  // nm, axis z
  double period = 0;           // nm
  std::vector<char> second{};  // whether each is of a second species; empty: none is
};
// Laws between the atoms of two species: 1 with 1, 1 with 2, 2 with 2; all with one cutoff.
using SpeciesLaws = std::array<AtomLaw, 3>;
double parallel_energy_of_atoms(const SpeciesLaws& laws, const AtomColumn& i, const AtomColumn& j, double distance,
                                double turn, double shift);
double parallel_energy_of_atoms(const AtomLaw& law, const AtomColumn& i, const AtomColumn& j, double distance,
                                double turn, double shift);

// The k-th point, k = 1, 2, ..., of a low-discrepancy sequence in three dimensions, which suits any symmetry of two
// tubes: the turns of both and the shift, as parts of a turn and of a period.
std::array<double, 3> registry_parts(int k);

// Mean and spread over registries (eV/nm), by this sequence.
struct RegistrySpread {
  double mean = 0, deviation = 0, least = 0, largest = 0;
};
RegistrySpread registry_spread(const SpeciesLaws& laws, const AtomColumn& i, const AtomColumn& j, double distance,
                               int samples = 2000);

struct Well {
  double distance = 0;  // nm
  double energy = 0;    // eV/nm parallel, eV crossed
};
Well parallel_well(const AtomLaw& law, const Shell& i, const Shell& j);
Well crossed_well(const AtomLaw& law, const Shell& i, const Shell& j, double angle);

}  // namespace ropewalk::calibrate
