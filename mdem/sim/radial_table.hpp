// The line density u as piecewise polynomials, for the contact kernel: no root, no exp. Two forms, of which an
// instruction set takes the one that costs it less.
//
// RadialTable, where a register holds all entries of a term, and in double precision: in rho^2.
//   y = (rho^2 - core^2)/delta + 1 in [1, 16); its exponent and its first mantissa bits number the segment, which
//   so are finest where u is steepest; t = y - (start of the segment);
//   u = sum_k c_k t^k,    force on j along the separation d:  F = -2/delta (du/dy) d.
//   delta puts the beginning of the switch, where the third derivative of u jumps, on the end of a segment.
//
// RadialPieces, where a lookup among more than four entries costs more than a quotient: in
//   w = (core^2 - pole)/(rho^2 - pole),
// in which u is so smooth that two pieces to either side of where the switch begins do; t = w - (middle of the
// piece). The pole lies between the core and where the law is singular, h = -c.
//
// In both du/dy, or du/dw, is interpolated at Chebyshev points and integrated from the cutoff inwards: u is
// continuous, and the force is the exact derivative of the energy whatever the error of the fit, which therefore
// costs accuracy (radial_table_test has how much) but no conservation of energy. Closer than the core the parabola
// of the law itself is used. Coordinates in units of `unit` (nm).
#pragma once

#include <Eigen/QR>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include "model/contact_line.hpp"

namespace ropewalk {

// Exponent bias and mantissa bits of the number format.
template <class T>
struct FloatBits;
template <>
struct FloatBits<float> {
  static constexpr int mantissa = 23, bias = 127;
};
template <>
struct FloatBits<double> {
  static constexpr int mantissa = 52, bias = 1023;
};

template <class T, int segments_, int degree_>
struct RadialTable {
  using Value = T;
  static constexpr int segments = segments_, degree = degree_;
  static constexpr int operations = 3 + 2 * (degree - 1);  // for the place, and for du/dy
  static constexpr int octaves = 4, per_octave = segments / octaves;
  static constexpr int mantissa_left = FloatBits<T>::mantissa - (per_octave == 4    ? 2
                                                                 : per_octave == 8  ? 3
                                                                 : per_octave == 16 ? 4
                                                                 : per_octave == 32 ? 5
                                                                                    : -1);

  alignas(64) T c[degree + 1][segments] = {};  // of u
  alignas(64) T d[degree][segments] = {};      // of du/dy: forces are the same bits with and without energies
  T scale = 0, shift = 0;                      // y = scale X + shift, X = rho^2 in units of unit^2
  T core2 = 0, cutoff2 = 0;                    // X
  T force = 0;               // -2/delta unit: times du/dy and the separation in units gives eV/nm^3 times nm
  T contact = 0, core = 0;   // of the law, nm
  T v0 = 0, v1 = 0, v2 = 0;  // u = v0 + e (v1 + e v2/2), e = rho - contact - core, below the core
  T unit = 0;                // nm

  RadialTable() = default;
  RadialTable(const LineDensity& law, double unit_nm);
  // u at a squared distance in units of unit^2: one alone, as a check and for what no loop over many is worth.
  T energy(T X) const;
};

// Pieces are counted from the cutoff: piece k lies within k edges.
template <class T, int degree_>
struct RadialPieces {
  using Value = T;
  static constexpr int pieces = 4, degree = degree_;
  static constexpr int operations = 4 + 2 * (degree - 1) + 2;  // w, t and its square; du/dw; factor w^2

  // By `entry`.
  alignas(64) T c[degree + 1][pieces] = {};  // of u
  alignas(64) T d[degree][pieces] = {};      // of du/dw (dw/dy)/w^2, which times w^2 is du/dy of a RadialTable
  alignas(64) T middle[pieces] = {};         // w
  T edge[pieces - 1] = {};                   // X where pieces meet, falling
  T width = 0, pole = 0;                     // w = width/(X - pole)

  RadialPieces() = default;
  // For the y of a table with this scale.
  RadialPieces(const LineDensity& law, double unit_nm, double scale);

  // The low two bits of -k, which is what k masks of true lanes add up to.
  static constexpr int entry(int k) { return (pieces - k) % pieces; }
};

// Pair displacements in single precision, and all in double.
struct MixedTable : RadialTable<float, 16, 7> {
  RadialPieces<float, 7> pieces;

  MixedTable() = default;
  MixedTable(const LineDensity& law, double unit_nm)
      : RadialTable(law, unit_nm), pieces(law, unit_nm, static_cast<double>(scale)) {}
};
using FullTable = RadialTable<double, 128, 7>;

// --- Definitions ------------------------------------------------------------------------------------

namespace detail {

// Where the switch begins at the end of a segment, with the smallest delta that reaches the cutoff.
inline double radial_delta(double core2, double switch2, double cutoff2, int octaves, int per_octave) {
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

}  // namespace detail

template <class T, int segments_, int degree_>
RadialTable<T, segments_, degree_>::RadialTable(const LineDensity& law, double unit_nm) {
  const auto squared = [](double x) { return x * x; };
  const double core_at = squared(law.contact + law.core_gap), end_at = squared(law.cutoff());
  const double delta =
      detail::radial_delta(core_at, squared(law.contact + law.switch_gap), end_at, octaves, per_octave);
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
  const detail::Interpolation<n> interpolation(0);
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
  // By trial, with tubes of (5,5) to (10,10).
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

  const detail::Interpolation<degree> interpolation(0.5);
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

}  // namespace ropewalk
