#include "sim/dynamics/modes.hpp"

#include <Spectra/GenEigsRealShiftSolver.h>

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

// (s^2 M + s C + K) q = 0 of the coordinates.
struct Quadratic {
  VectorXd mass;
  Matrix damping, stiffness;

  Quadratic(const Tangent& t, const Reduction& r)
      : mass(r.mass), damping(r.forces * t.damping * r.motions), stiffness(r.forces * t.stiffness * r.motions) {
    if (r.stiffness.size() > 0) stiffness += r.stiffness;
  }

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

// What Spectra asks for: (A - shift)^-1 of the displacements and the velocities. Displacements along neutral
// motions, and velocities along those that meet no damping either, span a space that A does not leave: what is left
// of the others without their parts in it has all other eigenvalues.
class Inverse {
 public:
  using Scalar = double;

  Inverse(const Quadratic& q, const Reduction& r, const ModeSearch& search)
      : q_(q), shift_(search.shift), lu_(q.at(search.shift)) {
    if (!search.without_neutral) return;
    const double fastest = q.damping.nonZeros() > 0 ? 1e-6 * q.damping.norm() / q.mass.minCoeff() : 0;
    for (const VectorXd& motion : r.neutral) {
      places_.push_back(motion);
      if (std::sqrt(q.kinetic_norm(VectorXd(q.damping * motion), -1)) <= fastest) speeds_.push_back(motion);
    }
  }
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
    for (const VectorXd& motion : places_) u -= motion.dot(q_.mass.cwiseProduct(u)) * motion;
    for (const VectorXd& motion : speeds_) v -= motion.dot(q_.mass.cwiseProduct(v)) * motion;
  }

 private:
  const Quadratic& q_;
  std::vector<VectorXd> places_, speeds_;  // that are left out
  double shift_;
  SlabLu lu_;
};

// The motion with unit kinetic energy, and with the phase that makes as much of it real as possible.
VectorXcd normal(const Quadratic& q, VectorXcd u) {
  const Complex squares = (u.array().square() * q.mass.array()).sum();
  if (std::abs(squares) > 0) u *= std::sqrt(std::conj(squares) / std::abs(squares));
  return u / std::sqrt(q.kinetic_norm(u, 1));
}

// Resolution of the tangent, 1/ps: the rate that it gives to a translation of all elements, which should be 0.
double resolution_of(const Quadratic& q, const Tangent& t, const Reduction& r) {
  double worst = 0;
  for (int axis = 0; axis < 3; ++axis) {
    VectorXd shift = VectorXd::Zero(t.mass.size());
    for (Eigen::Index row = axis; row < shift.size(); row += 6) shift[row] = 1;
    const VectorXd left = r.forces * VectorXd(t.stiffness * shift);
    worst = std::max(worst, std::sqrt(q.kinetic_norm(left, -1) / shift.dot(t.mass.cwiseProduct(shift))));
  }
  return std::sqrt(worst);
}

}  // namespace

Modes modes_of(const Tangent& tangent, const Reduction& reduction, const ModeSearch& search) {
  ROPEWALK_EXPECTS(search.count > 0 && search.shift > 0);
  const Quadratic q(tangent, reduction);
  const Eigen::Index most = 2 * q.size() - 2;
  const Eigen::Index wanted = std::min<Eigen::Index>(search.count, most);
  if (wanted < 1) throw std::runtime_error("nothing is free to move");
  Inverse inverse(q, reduction, search);
  Spectra::GenEigsRealShiftSolver<Inverse> solver(
      inverse, wanted, std::min(most + 2, 2 * wanted + search.more_vectors), search.shift);
  solver.init();
  const Eigen::Index found = solver.compute(Spectra::SortRule::LargestMagn, search.restarts, search.tolerance,
                                            Spectra::SortRule::LargestReal);
  Modes out;
  out.shift = search.shift;
  out.resolution = resolution_of(q, tangent, reduction);
  if (found < 1 && search.may_find_none) return out;
  if (found < 1) throw std::runtime_error("Arnoldi's method finds no eigenvalue");
  const VectorXcd rates = solver.eigenvalues();
  const Eigen::MatrixXcd vectors = solver.eigenvectors();
  for (Eigen::Index k = 0; k < rates.size(); ++k) {
    const Complex s = rates[k];
    out.reach = std::max(out.reach, std::abs(s - search.shift));
    if (s.imag() < 0) continue;
    const VectorXcd u = normal(q, vectors.col(k).head(q.size()));
    Mode mode{s, reduction.motions * u, 0};
    if (!search.without_neutral) {
      const double left = std::sqrt(q.kinetic_norm(q.times(s, u), -1)),
                   slope = std::sqrt(q.kinetic_norm(q.slope_times(s, u), -1));
      mode.residual = left / slope;
    }
    out.modes.push_back(std::move(mode));
  }
  std::stable_sort(out.modes.begin(), out.modes.end(),
                   [](const Mode& a, const Mode& b) { return a.rate.real() > b.rate.real(); });
  return out;
}

double neutral_below(const Modes& found) { return std::max(least_neutral, 3 * found.resolution); }

// A slice is closed to a ring: folded in its middle, it is a band twice as wide.
std::vector<int> elimination_order(const Topology& topology, const State& state) {
  std::vector<int> order = order_along(state);
  if (topology.groups.images == 0) return order;
  order.erase(std::remove_if(order.begin(), order.end(), [&](int e) { return topology.is_image(e); }), order.end());
  const auto z = [&](int e) { return state.position.z[static_cast<std::size_t>(e)]; };
  double middle = 0;
  for (const int e : order) middle += z(e) / static_cast<double>(order.size());
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return std::fabs(z(a) - middle) < std::fabs(z(b) - middle); });
  return order;
}

SlabCost cost_of_decomposition(const Simulation& s) {
  const Topology& topology = s.topology();
  const std::vector<int> order = elimination_order(topology, s.state());
  std::vector<Eigen::Index> place(s.state().size(), -1), farthest(6 * order.size());
  for (std::size_t k = 0; k < order.size(); ++k)
    place[static_cast<std::size_t>(order[k])] = static_cast<Eigen::Index>(k);
  for (std::size_t k = 0; k < farthest.size(); ++k) farthest[k] = static_cast<Eigen::Index>(k);
  const auto join = [&](int i, int j) {
    const Eigen::Index a = place[static_cast<std::size_t>(topology.original_of(i))],
                       b = place[static_cast<std::size_t>(topology.original_of(j))];
    for (Eigen::Index c = 0; c < 6; ++c) {
      Eigen::Index& far = farthest[static_cast<std::size_t>(6 * std::min(a, b) + c)];
      far = std::max(far, 6 * std::max(a, b) + 5);
    }
  };
  const double reach2 = s.interaction().cutoff() * s.interaction().cutoff();
  for (int t = 0; t < topology.tubes(); ++t)
    for (int i = topology.tube_begin[t]; i < topology.tube_begin[t + 1]; ++i) {
      if (i + 1 < topology.tube_begin[t + 1]) join(i, i + 1);
      if (!(s.list().cutoff > 0)) continue;
      const Vector3 x = s.state().position[static_cast<std::size_t>(i)];
      s.list().for_neighbours(i, [&](int j) {
        if ((s.state().position[static_cast<std::size_t>(j)] - x).squaredNorm() < reach2) join(i, j);
      });
    }
  return slab_cost(slab_ends(farthest));
}

}  // namespace ropewalk
