// The surface integrals of one pair of tubes, tabulated once so that a fit can evaluate many points.
//
// Only the slope E'(R) of the parallel energy is computed; the rest are integrals of it,
//   E(R) = -int_R^inf E'(S) dS,    X(R) = E(R, gamma) sin(gamma) = int E(sqrt(R^2 + t^2)) dt,
//   X(R) = -2 int_R^inf E'(S) sqrt(S^2 - R^2) dS,
// and u(rho) of van_der_waals.hpp. Between the kinks that the cutoff leaves in E', at cutoff +- r_i +- r_j, it is a
// Chebyshev series.
#pragma once

#include <functional>
#include <vector>

#include "contact/van_der_waals.hpp"

namespace ropewalk::calibrate {

class PairIntegral {
 public:
  // Tabulates from the gap `nearest` (nm) outwards; 0 means 0.4 sigma.
  PairIntegral(const AtomLaw& law, const Shell& i, const Shell& j, double nearest = 0);

  double nearest() const { return edges_.front(); }  // of R, nm
  double end() const { return edges_.back(); }       // nm
  double slope(double distance) const;               // E', eV/nm^2
  double parallel(double distance) const;            // E, eV/nm
  double crossed(double distance) const;             // X, eV
  double line_density(double rho) const;             // u, eV/nm^2
  Well parallel_well() const;
  Well crossed_well() const;  // at a right angle

 private:
  AtomLaw law_;
  Shell i_, j_;
  double contact_;
  std::vector<double> edges_;                // limits of the parts in R
  std::vector<std::vector<double>> series_;  // Chebyshev coefficients of E' h^8 for each part
};

// The same of two tubes of several walls, inside first: the sum over all pairs of walls that reach one another.
class WallsIntegral {
 public:
  WallsIntegral(const AtomLaw& law, const std::vector<Shell>& i, const std::vector<Shell>& j);
  WallsIntegral(const AtomLaw& law, const Shell& i, const Shell& j) : WallsIntegral(law, std::vector{i}, {j}) {}

  double parallel(double distance) const;      // E, eV/nm
  double crossed(double distance) const;       // X, eV
  double line_density(double rho) const;       // u, eV/nm^2
  Well parallel_well() const;
  Well crossed_well() const;  // at a right angle

 private:
  AtomLaw law_;
  double contact_;  // of the outer walls
  std::vector<PairIntegral> pairs_;
};

// u(rho) from the slope E'(R).
double abel_inverse(const AtomLaw& law, const Shell& i, const Shell& j, double rho,
                    const std::function<double(double)>& slope);

}  // namespace ropewalk::calibrate
