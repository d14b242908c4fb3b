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
// so that one LU decomposition of the size of K does (slab_lu.hpp).
//
// Units nm, ps, eV.
#pragma once

#include <complex>
#include <vector>

#include "sim/dynamics/slab_lu.hpp"
#include "sim/dynamics/tangent.hpp"

namespace ropewalk {

// The motions that constraints allow, as coordinates q: u = motions q, in an order along the rope.
struct Reduction {
  Tangent::Matrix motions;               // column by column
  Tangent::Matrix forces;                // row by row: the force on a coordinate, from those on all elements
  Eigen::VectorXd mass;                  // mass of each coordinate
  Tangent::Matrix stiffness;             // stiffness of what the constraints bear
  std::vector<Eigen::VectorXd> neutral;  // coordinates of motions that meet no stiffness, orthonormal by the masses
};

struct Mode {
  std::complex<double> rate;  // s, 1/ps; of a pair of conjugates the one with the positive imaginary part
  // The eigenvector u, scaled to u* M u = 1. Its complex phase makes the real part as large as possible.
  Eigen::VectorXcd shape;
  double residual = 0;  // 1/ps: the error of s that the forces left over stand for
};

struct ModeSearch {
  int count = 12;
  double shift = 0.05;  // 1/ps
  // Motions that meet no stiffness (Reduction::neutral) are left out of the search, and of the shapes.
  bool without_neutral = false;
  // Vectors of Arnoldi's method beyond twice the count, and how often it begins again. With few of them it finds
  // what stands alone, and no error if there is nothing.
  int more_vectors = 40, restarts = 300;
  bool may_find_none = false;
  double tolerance = 1e-11;  // relative error of 1/(rate - shift)
};

struct Modes {
  std::vector<Mode> modes;  // the largest real part first
  double shift = 0;         // 1/ps
  // 1/ps: no other eigenvalue is nearer to the shift.
  double reach = 0;
  // 1/ps: rates below cannot be told from zero. The stiffness against a shift of the whole is not quite zero, but
  // this number squared times its mass.
  double resolution = 0;
};

// 1/ps: the real and imaginary parts of motions that change nothing, such as moves of the whole, are below this.
double neutral_below(const Modes& found);

// Throws std::runtime_error where the decomposition fails, or too few of the eigenvalues converge.
Modes modes_of(const Tangent& tangent, const Reduction& reduction, const ModeSearch& search);

// The elements in the order of the decomposition; those of a slice without its images.
std::vector<int> elimination_order(const Topology& topology, const State& state);

// Memory and operations that the decomposition will take, by which elements are within reach of one another.
SlabCost cost_of_decomposition(const Simulation& simulation);

}  // namespace ropewalk
