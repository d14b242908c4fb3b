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

#include "model/contact/line.hpp"

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

  alignas(64) T c[degree + 1][segments] = {};  // coefficients of u
  alignas(64) T d[degree][segments] = {};      // of du/dy: forces are the same bits with and without energies
  T scale = 0, shift = 0;                      // y = scale X + shift, X = rho^2 in units of unit^2
  T core2 = 0, cutoff2 = 0;                    // X
  T force = 0;               // -2/delta unit: times du/dy and the separation in units gives eV/nm^3 times nm
  T contact = 0, core = 0;   // limits of the law, nm
  T v0 = 0, v1 = 0, v2 = 0;  // u = v0 + e (v1 + e v2/2), e = rho - contact - core, below the core
  T unit = 0;                // nm

  RadialTable() = default;
  RadialTable(const LineDensity& law, double unit_nm);
  // u at one squared distance, in units of unit^2; loops use the vector form.
  T energy(T X) const;
};

// Pieces are counted from the cutoff: piece k lies within k edges.
template <class T, int degree_>
struct RadialPieces {
  using Value = T;
  static constexpr int pieces = 4, degree = degree_;
  static constexpr int operations = 4 + 2 * (degree - 1) + 2;  // w, t and its square; du/dw; factor w^2

  // `entry` is the last index of these arrays.
  alignas(64) T c[degree + 1][pieces] = {};  // coefficients of u
  alignas(64) T d[degree][pieces] = {};      // likewise of du/dw (dw/dy)/w^2; times w^2: du/dy of a RadialTable
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

}  // namespace ropewalk
