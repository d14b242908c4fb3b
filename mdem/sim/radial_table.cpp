#include "sim/radial_table.hpp"

namespace ropewalk {
namespace {

// u, du/dx and d2u/dx2 at x = rho^2.
struct Jet {
  double u, u1, u2;
};

Jet jet(const LineDensity& d, double x) {
  const double rho = std::sqrt(x);
  const RadialTerms t = d.terms(rho);
  return {t.energy, t.derivative / (2 * rho), (t.second - t.derivative / rho) / (4 * x)};
}

}  // namespace

RadialTable RadialTable::of(const LineDensity& density) {
  RadialTable t;
  t.density = density;
  const double low = 0.7 * density.contact, core = density.contact + density.core_gap, high = density.cutoff();
  // A node lies where the core begins, since the third derivative jumps there.
  const double below = std::round(intervals * (core * core - low * low) / (high * high - low * low));
  const double width = (high * high - core * core) / (intervals - below);
  t.from = core * core - below * width;
  t.to = high * high;
  t.inverse_width = 1 / width;
  t.coefficients.resize(static_cast<std::size_t>(intervals) * (degree + 1));
  Jet a = jet(density, t.from);
  for (int k = 0; k < intervals; ++k) {
    const Jet b = jet(density, t.from + (k + 1) * width);
    double* c = &t.coefficients[static_cast<std::size_t>(k) * (degree + 1)];
    const double v1 = a.u1 * width, v2 = 0.5 * a.u2 * width * width;
    // What is left at the far end for the three highest terms: value, slope, half the curvature.
    const double r0 = b.u - a.u - v1 - v2, r1 = b.u1 * width - v1 - 2 * v2, r2 = 0.5 * b.u2 * width * width - v2;
    c[0] = a.u;
    c[1] = v1;
    c[2] = v2;
    c[3] = 10 * r0 - 4 * r1 + r2;
    c[4] = -15 * r0 + 7 * r1 - 2 * r2;
    c[5] = 6 * r0 - 3 * r1 + r2;
    a = b;
  }
  return t;
}

RadialTable::Value RadialTable::at(double x) const {
  const double y = (x - from) * inverse_width;
  const int k = std::min(static_cast<int>(y), intervals - 1);
  const double t = y - k;
  const double* c = &coefficients[static_cast<std::size_t>(k) * (degree + 1)];
  return {c[0] + t * (c[1] + t * (c[2] + t * (c[3] + t * (c[4] + t * c[5])))),
          inverse_width * (c[1] + t * (2 * c[2] + t * (3 * c[3] + t * (4 * c[4] + t * 5 * c[5]))))};
}

}  // namespace ropewalk
