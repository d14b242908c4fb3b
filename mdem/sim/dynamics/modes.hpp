// The motions by which a state at rest is left, or to which it comes back: eigenvalues s of
//
//   (s^2 M + s C + K) u = 0
//
// with the tangent of the state (tangent.hpp): u exp(s t) grows if the real part of s is positive. Those next to a
// positive shift are found, by Arnoldi's method on the inverse: R. B. Lehoucq, D. C. Sorensen, C. Yang, ARPACK
// Users' Guide (SIAM, 1998). With the velocity v = s u
//
//   (A - shift)^-1 (a, b) = (u, a + shift u),   (shift^2 M + shift C + K) u = -(M b + C a + shift M a)
//
// so that one sparse LU decomposition of the size of K does.
//
// Units nm, ps, eV.
#pragma once

#include <complex>
#include <optional>
#include <vector>

#include "sim/dynamics/tangent.hpp"

namespace ropewalk {

struct Mode {
  std::complex<double> rate;  // s, 1/ps; of a pair of conjugates the one with the positive imaginary part
  // The eigenvector u, scaled to u* M u = 1. Its complex phase makes the real part as large as possible.
  Eigen::VectorXcd shape;
  double residual = 0;  // 1/ps: the error of s that the forces left over stand for
};

struct ModeSearch {
  int count = 12;
  double shift = 0.05;  // 1/ps
};

struct Modes {
  std::vector<Mode> modes;  // the largest real part first
  double shift = 0;         // 1/ps
  // 1/ps: no other eigenvalue is nearer to the shift.
  double reach = 0;
  // 1/ps: rates below cannot be told from zero. The stiffness against a shift of the whole is not quite zero, but
  // this number squared times its mass.
  double resolution = 0;
  std::size_t nonzeros = 0;  // of the decomposition
};

// 1/ps: the real and imaginary parts of motions that change nothing, such as moves of the whole, are below this.
double neutral_below(const Modes& found);

// `free`: of each unknown (free_unknowns). Throws std::runtime_error where the decomposition fails, or too few of
// the eigenvalues converge.
Modes modes_of(const Tangent& tangent, const std::vector<char>& free, const ModeSearch& search);

// Bytes of the decomposition, by the elements within reach of one another; for a warning before it is tried.
double bytes_of_decomposition(const Simulation& simulation);

// eV/nm: the largest force on a free unknown, torques over the radius.
double largest_free_force(const Topology& topology, const Eigen::VectorXd& force, const std::vector<char>& free);

}  // namespace ropewalk
