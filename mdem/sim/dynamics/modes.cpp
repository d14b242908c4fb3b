#include "sim/dynamics/modes.hpp"

#include <Spectra/GenEigsRealShiftSolver.h>

#include <Eigen/SparseLU>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "model/contract.hpp"

namespace ropewalk {
namespace {

using Complex = std::complex<double>;
using Eigen::VectorXcd;
using Eigen::VectorXd;
using Matrix = Tangent::Matrix;

constexpr double least_neutral = 1e-4;  // 1/ps

// The free unknowns, in the order of the elements along the longest extent: matrices of ropes are then bands.
class FreeUnknowns {
 public:
  FreeUnknowns(const std::vector<char>& free, const std::vector<int>& order) : all_(6 * order.size()) {
    ROPEWALK_EXPECTS(free.size() == all_);
    for (const int e : order)
      for (int k = 6 * e; k < 6 * e + 6; ++k)
        if (free[static_cast<std::size_t>(k)]) at_.push_back(k);
  }
  Eigen::Index size() const { return static_cast<Eigen::Index>(at_.size()); }
  VectorXd chosen(const VectorXd& all) const {
    VectorXd out(size());
    for (std::size_t k = 0; k < at_.size(); ++k) out[static_cast<Eigen::Index>(k)] = all[at_[k]];
    return out;
  }
  template <class Vector>
  Vector spread(const Vector& some) const {
    Vector out = Vector::Zero(static_cast<Eigen::Index>(all_));
    for (std::size_t k = 0; k < at_.size(); ++k) out[at_[k]] = some[static_cast<Eigen::Index>(k)];
    return out;
  }
  Matrix chosen(const Matrix& all) const {
    std::vector<int> place(all_, -1);
    for (std::size_t k = 0; k < at_.size(); ++k) place[static_cast<std::size_t>(at_[k])] = static_cast<int>(k);
    std::vector<Eigen::Triplet<double>> entries;
    for (int column = 0; column < all.outerSize(); ++column)
      for (Matrix::InnerIterator entry(all, column); entry; ++entry) {
        const int i = place[static_cast<std::size_t>(entry.row())], j = place[static_cast<std::size_t>(column)];
        if (i >= 0 && j >= 0) entries.emplace_back(i, j, entry.value());
      }
    Matrix out(size(), size());
    out.setFromTriplets(entries.begin(), entries.end());
    return out;
  }

 private:
  std::size_t all_;
  std::vector<int> at_;
};

// (s^2 M + s C + K) u = 0 of the free unknowns.
struct Quadratic {
  VectorXd mass;
  Matrix damping, stiffness;

  Quadratic(const Tangent& t, const FreeUnknowns& f)
      : mass(f.chosen(t.mass)), damping(f.chosen(t.damping)), stiffness(f.chosen(t.stiffness)) {}

  Eigen::Index size() const { return mass.size(); }
  Matrix at(double s) const {
    Matrix inertia(size(), size());
    inertia.setIdentity();
    inertia.diagonal() = s * s * mass;
    return inertia + s * damping + stiffness;
  }
  VectorXcd times(Complex s, const VectorXcd& u) const {
    return s * s * mass.cwiseProduct(u) + s * (damping * u) + stiffness * u;
  }
  VectorXcd slope_times(Complex s, const VectorXcd& u) const {
    return 2.0 * s * mass.cwiseProduct(u) + damping * u;
  }
  template <class Vector>
  double kinetic_norm(const Vector& v, double power) const {
    return (v.array().abs2() * mass.array().pow(power)).sum();
  }
};

class Decomposition {
 public:
  explicit Decomposition(const Matrix& matrix) {
    lu_.compute(matrix);
    if (lu_.info() != Eigen::Success)
      throw std::runtime_error("the matrix cannot be decomposed: " + lu_.lastErrorMessage());
  }
  VectorXd solve(const VectorXd& b) const { return lu_.solve(b); }
  std::size_t nonzeros() const { return static_cast<std::size_t>(lu_.nnzL() + lu_.nnzU()); }

 private:
  Eigen::SparseLU<Matrix, Eigen::NaturalOrdering<int>> lu_;
};

// What Spectra asks for: (A - shift)^-1 of the displacements and the velocities.
class Inverse {
 public:
  using Scalar = double;

  Inverse(const Quadratic& q, double shift) : q_(q), shift_(shift), lu_(q.at(shift)) {}
  Eigen::Index rows() const { return 2 * q_.size(); }
  Eigen::Index cols() const { return rows(); }
  void set_shift(double) {}
  void perform_op(const double* in, double* out) const {
    const Eigen::Index n = q_.size();
    const Eigen::Map<const VectorXd> a(in, n), b(in + n, n);
    Eigen::Map<VectorXd> u(out, n), v(out + n, n);
    const VectorXd inertial = q_.mass.cwiseProduct(b + shift_ * a);
    u = -lu_.solve(inertial + q_.damping * a);
    v = a + shift_ * u;
  }
  std::size_t nonzeros() const { return lu_.nonzeros(); }

 private:
  const Quadratic& q_;
  double shift_;
  Decomposition lu_;
};

// Of unit kinetic energy, and turned so that as much as possible of it is real.
VectorXcd normal(const Quadratic& q, VectorXcd u) {
  const Complex squares = (u.array().square() * q.mass.array()).sum();
  if (std::abs(squares) > 0) u *= std::sqrt(std::conj(squares) / std::abs(squares));
  return u / std::sqrt(q.kinetic_norm(u, 1));
}

// Moves of the whole along the axes change no force.
double resolution_of(const Quadratic& q, const FreeUnknowns& f, Eigen::Index all) {
  double worst = 0;
  for (int axis = 0; axis < 3; ++axis) {
    VectorXd shift = VectorXd::Zero(all);
    for (Eigen::Index row = axis; row < all; row += 6) shift[row] = 1;
    const VectorXd u = f.chosen(shift);
    worst = std::max(worst, std::sqrt(q.kinetic_norm(q.stiffness * u, -1) / q.kinetic_norm(u, 1)));
  }
  return std::sqrt(worst);
}

}  // namespace

Modes modes_of(const Tangent& tangent, const std::vector<char>& free, const ModeSearch& search) {
  ROPEWALK_EXPECTS(search.count > 0 && search.shift > 0);
  const FreeUnknowns unknowns(free, tangent.order);
  const Quadratic q(tangent, unknowns);
  const Eigen::Index most = 2 * q.size() - 2;
  const Eigen::Index wanted = std::min<Eigen::Index>(search.count, most);
  if (wanted < 1) throw std::runtime_error("nothing is free to move");
  Inverse inverse(q, search.shift);
  Spectra::GenEigsRealShiftSolver<Inverse> solver(inverse, wanted, std::min(most + 2, 2 * wanted + 40),
                                                  search.shift);
  solver.init();
  const Eigen::Index found =
      solver.compute(Spectra::SortRule::LargestMagn, 300, 1e-11, Spectra::SortRule::LargestReal);
  Modes out;
  out.shift = search.shift;
  out.nonzeros = inverse.nonzeros();
  out.resolution = resolution_of(q, unknowns, tangent.mass.size());
  if (found < 1) throw std::runtime_error("Arnoldi's method finds no eigenvalue");
  const VectorXcd rates = solver.eigenvalues();
  const Eigen::MatrixXcd vectors = solver.eigenvectors();
  for (Eigen::Index k = 0; k < rates.size(); ++k) {
    const Complex s = rates[k];
    out.reach = std::max(out.reach, std::abs(s - search.shift));
    if (s.imag() < 0) continue;
    const VectorXcd u = normal(q, vectors.col(k).head(q.size()));
    const double left = std::sqrt(q.kinetic_norm(q.times(s, u), -1)),
                 slope = std::sqrt(q.kinetic_norm(q.slope_times(s, u), -1));
    out.modes.push_back({s, unknowns.spread(u), left / slope});
  }
  std::stable_sort(out.modes.begin(), out.modes.end(),
                   [](const Mode& a, const Mode& b) { return a.rate.real() > b.rate.real(); });
  return out;
}

double largest_free_force(const Topology& topology, const VectorXd& force, const std::vector<char>& free) {
  double largest = 0;
  for (int e = 0; e < topology.elements(); ++e) {
    Eigen::Matrix<double, 6, 1> f = force.segment<6>(6 * static_cast<Eigen::Index>(e));
    for (int k = 0; k < 6; ++k)
      if (!free[static_cast<std::size_t>(6 * e + k)]) f[k] = 0;
    largest = std::max({largest, f.head<3>().norm(), f.tail<3>().norm() / topology.type_of_element(e).radius});
  }
  return largest;
}

double neutral_below(const Modes& found) { return std::max(least_neutral, 3 * found.resolution); }

// A band as wide as the elements that reach one another lie apart in the order of the decomposition; three times as
// many numbers as in the half of it, since rows are exchanged.
double bytes_of_decomposition(const Simulation& simulation) {
  const std::vector<int> order = order_along(simulation.state());
  std::vector<int> place(order.size());
  for (std::size_t k = 0; k < order.size(); ++k) place[static_cast<std::size_t>(order[k])] = static_cast<int>(k);
  double sum = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    int farthest = 1;
    if (simulation.list().cutoff > 0)
      simulation.list().for_neighbours(static_cast<int>(i), [&](int j) {
        farthest = std::max(farthest, std::abs(place[static_cast<std::size_t>(j)] - place[i]));
      });
    sum += farthest;
  }
  return 3 * 36 * sum * (sizeof(double) + sizeof(int));
}

}  // namespace ropewalk
