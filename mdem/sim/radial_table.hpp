// A line density u(rho) as a table for the hot loop: piecewise quintic Hermite polynomials in x = rho^2, exact in
// value, slope and curvature at the nodes. The force follows from the polynomial itself, so the tabulated force is
// the exact gradient of the tabulated energy: nothing is gained or lost.
#pragma once

#include <vector>

#include "model/contact_line.hpp"

namespace ropewalk {

struct RadialTable {
  static constexpr int intervals = 1024;
  static constexpr int degree = 5;

  LineDensity density;
  double from = 0, to = 0;           // nm^2; below `from` the density itself is to be asked, beyond `to` it is zero
  double inverse_width = 0;          // 1/nm^2
  std::vector<double> coefficients;  // of t = (x - x_k)/width in interval k, at k * (degree + 1)

  static RadialTable of(const LineDensity& density);

  struct Value {
    double energy;      // u
    double derivative;  // du/dx
  };
  // x < to; any x >= from.
  Value at(double x) const;
};

}  // namespace ropewalk
