// The twist at which a closed ring leaves its plane.
#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <complex>

#include "cases/common/chain.hpp"

namespace ropewalk::validate::michell_ring {
namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

// In cylindrical coordinates all elements of the ring are equal. So one element and its two neighbours suffice, and
// a motion with m waves around the ring needs only a matrix of 6 x 6.
class TwistedRing {
 public:
  TwistedRing(const ParameterSet& set, int elements, double twist)
      : set_(set), step_(2 * units::pi / elements), twist_(twist / elements) {
    position_ = Vector3(0.5 * set.element_length / std::sin(0.5 * step_), 0, 0);
    axis_ = turn_about(Vector3::UnitX(), -0.5 * units::pi);  // body z to the tangent y
    settle();
  }

  // Lowest eigenvalue for m waves around the ring.
  double lowest(int waves) const {
    Eigen::Matrix<std::complex<double>, 6, 6> sum = Eigen::Matrix<std::complex<double>, 6, 6>::Zero();
    for (int k = -1; k <= 1; ++k)
      sum += derivative(k).cast<std::complex<double>>() * std::polar(1.0, waves * k * step_);
    const Eigen::Matrix<std::complex<double>, 6, 6> hermitian = 0.5 * (sum + sum.adjoint());
    return Eigen::SelfAdjointEigenSolver<decltype(sum)>(hermitian).eigenvalues()(0);
  }

 private:
  using Moves = std::array<Vector6, 3>;  // moves of the elements -1, 0, 1, each in its own cylinder frame

  // Force and torque on element 0.
  Vector6 load(const Moves& moves) const {
    std::array<Vector3, 3> at;
    std::array<Frame, 3> frame;
    for (int k = -1; k <= 1; ++k) {
      const auto e = static_cast<std::size_t>(k + 1);
      const Quaternion around = turn_about(Vector3::UnitZ(), k * step_);
      at[e] = around * (position_ + moves[e].head<3>());
      frame[e] =
          frame_of(around * small_turn(moves[e].tail<3>()) * axis_ * turn_about(Vector3::UnitZ(), k * twist_));
    }
    const auto bond = [&](std::size_t i) {
      return bond_energy_and_gradient(set_.bond, set_.element_length, at[i + 1] - at[i], frame[i], frame[i + 1]);
    };
    const BondForce before = bond(0), after = bond(1);
    Vector6 out;
    out << before.force_j - after.force_j, before.torque_j + after.torque_i;
    return out;
  }

  Matrix6 derivative(int element) const {
    constexpr double h = 1e-5;
    Matrix6 out;
    for (int c = 0; c < 6; ++c) {
      Moves plus, minus;
      plus.fill(Vector6::Zero());
      minus.fill(Vector6::Zero());
      plus[static_cast<std::size_t>(element + 1)](c) = h;
      minus[static_cast<std::size_t>(element + 1)](c) = -h;
      out.col(c) = (load(minus) - load(plus)) / (2 * h);
    }
    return out;
  }

  // The twisted ring carries a shear force along its axis, which tilts the elements a little. Newton's method finds
  // the rest state among motions that are equal for all elements; shifts along and turns about the ring's axis are
  // free.
  void settle() {
    Moves none;
    none.fill(Vector6::Zero());
    for (int k = 0; k < 20; ++k) {
      const Matrix6 stiffness = derivative(-1) + derivative(0) + derivative(1);
      Eigen::CompleteOrthogonalDecomposition<Matrix6> solver;
      solver.setThreshold(1e-7);
      solver.compute(stiffness);
      const Vector6 move = solver.solve(load(none));
      position_ += move.head<3>();
      axis_ = (small_turn(move.tail<3>()) * axis_).normalized();
    }
  }

  const ParameterSet& set_;
  double step_, twist_;  // angle around the ring and twist from element to element
  Vector3 position_;
  Quaternion axis_;
};

double critical_twist(const ParameterSet& set, int elements, int waves, double expected) {
  return zero_between([&](double twist) { return TwistedRing(set, elements, twist).lowest(waves); }, 0.6 * expected,
                      1.5 * expected);
}

CaseResult run(const CaseContext& context) {
  const ParameterSet model = context.model(), oracle = context.set();
  const auto michell = [&](int waves) {
    return 2 * units::pi * std::sqrt(waves * waves - 1.0) * oracle.bond.bend / oracle.bond.twist;
  };
  refuse_slip(oracle, michell(4) / 240 * oracle.bond.twist / oracle.element_length);
  CaseResult result;
  for (const int waves : {2, 3, 4})
    result.check_relative("critical twist, " + std::to_string(waves) + " waves, 240 elements",
                          critical_twist(model, 240, waves, michell(waves)), michell(waves), 1e-2, "rad",
                          "a bond twists by 0.05 to 0.11 rad");
  if (context.sets.size() > 1) {
    const ParameterSet& paper = context.set(1);
    const double published = 2 * units::pi * std::sqrt(3.0) * paper.bond.bend / paper.bond.twist;
    result.check_relative("critical twist, 2 waves, published constants",
                          critical_twist(context.model(1), 240, 2, published), published, 1e-2, "rad", "12.21 rad");
  }
  std::vector<double> elements, twists;
  for (const int n : {40, 60, 80, 120, 180, 240}) {
    elements.push_back(n);
    twists.push_back(critical_twist(model, n, 2, michell(2)));
  }
  result.figure("Critical twist of a ring against the number of its elements", {"elements", "", true},
                {"critical twist", "rad"}, "The error falls with the square of the twist in a bond.",
                {theory_curve("2 pi sqrt(3) EI/GJ", 0, 240, [&](double) { return michell(2); }),
                 model_points("ring of elements", elements, twists)});
  return result;
}

const RegisteredCase registered([] {
  Case c;
  c.name = "michell-ring";
  c.order = 40;
  c.sets = {"cnt-10-10-tersoff", "cnt-10-10-paper"};
  c.law = Case::Law::none;
  c.run = run;
  c.turns_red = {wrong_EI(1.1), wrong_GJ(0.9)};
  return c;
});

}  // namespace
}  // namespace ropewalk::validate::michell_ring
