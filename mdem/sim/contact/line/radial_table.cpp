#include "sim/contact/line/radial_table.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include "model/contract.hpp"

namespace ropewalk {
namespace {

// The smallest delta that reaches the cutoff and lets the switch begin at the end of a segment.
double radial_delta(double core2, double switch2, double cutoff2, int octaves, int per_octave) {
  const double last = std::exp2(octaves), smallest = (cutoff2 - core2) / (last - 1);
  for (int k = octaves * per_octave - 1; k > 0; --k) {
    const double start = std::exp2(k / per_octave) * (1 + static_cast<double>(k % per_octave) / per_octave);
    const double delta = (switch2 - core2) / (start - 1);
    if (delta >= smallest) return delta;
  }
  return smallest;
}

// Terms of the polynomial through n Chebyshev points of (0, 1), in powers of x - origin.
template <int n>
class Interpolation {
 public:
  explicit Interpolation(double origin) {
    Eigen::Matrix<double, n, n> powers;
    for (int k = 0; k < n; ++k) {
      x[k] = 0.5 - 0.5 * std::cos(units::pi * (k + 0.5) / n);
      for (int m = 0; m < n; ++m) powers(k, m) = std::pow(x[k] - origin, m);
    }
    solver.compute(powers);
  }
  template <class F>
  Eigen::Matrix<double, n, 1> operator()(const F& f) const {
    Eigen::Matrix<double, n, 1> values;
    for (int m = 0; m < n; ++m) values[m] = f(x[m]);
    return solver.solve(values);
  }

 private:
  Eigen::Matrix<double, n, 1> x;
  Eigen::ColPivHouseholderQR<Eigen::Matrix<double, n, n>> solver;
};

}  // namespace

template <class T, int segments_, int degree_>
RadialTable<T, segments_, degree_>::RadialTable(const LineDensity& law, double unit_nm) {
  ROPEWALK_EXPECTS(unit_nm > 0 && law.core_gap < law.cutoff_gap);
  const auto squared = [](double x) { return x * x; };
  const double core_at = squared(law.contact + law.core_gap), end_at = squared(law.cutoff());
  const double delta = radial_delta(core_at, squared(law.contact + law.switch_gap), end_at, octaves, per_octave);
  const auto y_of = [&](double x) { return 1 + (x - core_at) / delta; };
  const auto slope = [&](double y) {  // du/dy
    const double rho = std::sqrt(core_at + (y - 1) * delta);
    return law.terms(rho).derivative * delta / (2 * rho);
  };
  unit = static_cast<T>(unit_nm);
  scale = static_cast<T>(unit_nm * unit_nm / delta);
  shift = static_cast<T>(1 - core_at / delta);
  core2 = static_cast<T>(core_at / (unit_nm * unit_nm));
  cutoff2 = static_cast<T>(end_at / (unit_nm * unit_nm));
  force = static_cast<T>(-2 / delta * unit_nm);
  contact = static_cast<T>(law.contact);
  core = static_cast<T>(law.core_gap);
  const RadialTerms at_core = law.terms(law.contact + law.core_gap);
  v0 = static_cast<T>(at_core.energy);
  v1 = static_cast<T>(at_core.derivative);
  v2 = static_cast<T>(at_core.second);

  constexpr int n = degree;  // terms of du/dy
  const Interpolation<n> interpolation(0);
  const double y_end = y_of(end_at);
  double u_end = 0;  // at the end of the present segment
  for (int k = segments - 1; k >= 0; --k) {
    const double octave = std::exp2(k / per_octave);
    const double start = octave * (1 + static_cast<double>(k % per_octave) / per_octave);
    const double width = std::min(octave / per_octave, y_end - start);
    if (width <= 0) continue;
    const auto terms = interpolation([&](double x) { return slope(start + width * x) * width; });
    double u = u_end;
    for (int m = 0; m < n; ++m) u -= terms[m] / (m + 1);
    const auto at = static_cast<std::size_t>((FloatBits<T>::bias * per_octave + k) % segments);
    c[0][at] = static_cast<T>(u);
    for (int m = 0; m < n; ++m) {
      const double of_slope = terms[m] / std::pow(width, m + 1);
      c[m + 1][at] = static_cast<T>(of_slope / (m + 1));
      d[m][at] = static_cast<T>(of_slope);
    }
    u_end = u;
  }
}

template <class T, int segments_, int degree_>
T RadialTable<T, segments_, degree_>::energy(T X) const {
  if (X >= cutoff2) return 0;
  if (X < core2) {
    const T e = std::sqrt(X) * unit - (contact + core);
    return v0 + e * (v1 + e * v2 / 2);
  }
  using Bits = std::conditional_t<sizeof(T) == 4, std::uint32_t, std::uint64_t>;
  const T y = scale * X + shift;
  Bits bits;
  std::memcpy(&bits, &y, sizeof bits);
  const Bits start_bits = bits >> mantissa_left << mantissa_left;
  T start;
  std::memcpy(&start, &start_bits, sizeof start);
  const auto k = static_cast<std::size_t>(bits >> mantissa_left) % segments;
  const T s = y - start;
  T u = c[degree][k];
  for (int m = degree - 1; m >= 0; --m) u = u * s + c[m][k];
  return u;
}

template <class T, int degree_>
RadialPieces<T, degree_>::RadialPieces(const LineDensity& law, double unit_nm, double scale) {
  const auto squared = [](double x) { return x * x; };
  const double core_at = squared(law.contact + law.core_gap), end_at = squared(law.cutoff());
  const double switch_at = squared(law.contact + law.switch_gap);
  const double singular_at = squared(std::max(law.contact - law.c, 0.0));
  // Values found by trial, with tubes of (5,5) to (10,10).
  const double pole_at = core_at - 0.72 * (core_at - singular_at), across = core_at - pole_at;
  const double unit2 = squared(unit_nm);
  width = static_cast<T>(across / unit2);
  pole = static_cast<T>(pole_at / unit2);
  const auto w_of = [&](double x) { return across / (x - pole_at); };
  const auto x_of = [&](double w) { return pole_at + across / w; };
  const auto slope = [&](double w) {  // du/dw
    const double rho = std::min(std::sqrt(x_of(w)), law.cutoff());
    return -law.terms(rho).derivative / (2 * rho) * across / squared(w);
  };
  const double outer = w_of(end_at), middle_edge = w_of(switch_at);
  const double edges[pieces + 1] = {outer, 0.5 * (outer + middle_edge), middle_edge, 0.5 * (middle_edge + 1), 1};
  const double per_y = -unit2 / (across * scale);  // (dw/dy)/w^2

  const Interpolation<degree> interpolation(0.5);
  double u = 0;  // at the piece's outer edge
  for (int k = 0; k < pieces; ++k) {
    const double from = edges[k], across_piece = edges[k + 1] - from;
    const auto at = static_cast<std::size_t>(entry(k));
    if (k > 0) edge[k - 1] = static_cast<T>(x_of(from) / unit2);
    middle[at] = static_cast<T>(from + 0.5 * across_piece);
    const auto terms = interpolation([&](double x) { return slope(from + across_piece * x) * across_piece; });
    double at_middle = u;
    for (int m = 0; m < degree; ++m) at_middle -= terms[m] * std::pow(-0.5, m + 1) / (m + 1);
    c[0][at] = static_cast<T>(at_middle);
    u = at_middle;
    for (int m = 0; m < degree; ++m) {
      const double of_slope = terms[m] / std::pow(across_piece, m + 1);
      c[m + 1][at] = static_cast<T>(of_slope / (m + 1));
      d[m][at] = static_cast<T>(of_slope * per_y);
      u += terms[m] * std::pow(0.5, m + 1) / (m + 1);
    }
  }
}

// MixedTable and FullTable; and the pieces in double, which show the error of the form without that of floats.
template struct RadialTable<float, 16, 7>;
template struct RadialTable<double, 128, 7>;
template struct RadialPieces<float, 7>;
template struct RadialPieces<double, 7>;

}  // namespace ropewalk
