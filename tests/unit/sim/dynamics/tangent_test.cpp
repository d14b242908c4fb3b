// K and C of a state against differences of its energy and the power of its damping.
#include "sim/dynamics/tangent.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "scene/ends/grip.hpp"
#include "scene/ends/twist.hpp"
#include "scene/loads/fix.hpp"
#include "sim/contact/line/law.hpp"
#include "sim/statics/allowed_motions.hpp"
#include "sim/statics/reduction.hpp"
#include "sim/statics/stiffness.hpp"
#include "unit/support.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

using Eigen::MatrixXd;
using Eigen::VectorXd;

Interaction damped_line() {
  Interaction in;
  in.law = line_law({test::line_contact(0.6785, 6, 0.6785, 6)});
  in.damping.contact = {20, 1.7, 2.6};
  in.damping.bond.rate = 0.3;
  return in;
}

Simulation bundle(LoadsAndConstraints loads = {}, Interaction in = damped_line()) {
  Topology topology = test::published_topology();
  const State state = test::disordered_bundle(topology, 4, 9, 1.72, 0.03, 3);
  return Simulation(topology, std::move(in), std::move(loads), state, 0.01);
}

VectorXd random_motion(Eigen::Index n, unsigned seed) {
  test::Random random(seed);
  VectorXd u(n);
  for (Eigen::Index k = 0; k < n; ++k) u[k] = random.uniform(-1, 1);
  return u;
}

double energy_along(const Simulation& s, const VectorXd& u, double by) {
  return s.forces_at(moved(s.state(), by * u), Interaction::Precision::full).energy.potential();
}

TEST(Tangent, IsTheSecondDerivativeOfTheEnergy) {
  const Simulation s = bundle();
  const Tangent t = tangent_of(s);
  EXPECT_LT(t.error, 1e-7);
  EXPECT_LT(t.evaluations, 24 * s.topology().elements()) << "elements that do not meet move in one evaluation";
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const VectorXd u = random_motion(t.mass.size(), seed);
    constexpr double h = 2e-4;
    const double second = (energy_along(s, u, h) - 2 * energy_along(s, u, 0) + energy_along(s, u, -h)) / (h * h);
    const double first = (energy_along(s, u, h) - energy_along(s, u, -h)) / (2 * h);
    EXPECT_NEAR(u.dot(t.stiffness * u), second, 1e-4 * std::fabs(second)) << seed;
    EXPECT_NEAR(-u.dot(t.force), first, 1e-4 * std::fabs(first)) << seed;
  }
}

// The rotation vectors of two turns do not add up: K has half of the torque of an element in its antisymmetric
// part, and nothing else.
TEST(Tangent, IsSymmetricButForHalfOfTheTorque) {
  const Simulation s = bundle();
  const Tangent t = tangent_of(s);
  const MatrixXd k = MatrixXd(t.stiffness);
  MatrixXd odd = 0.5 * (k - k.transpose());
  double torques = 0;
  for (int e = 0; e < s.topology().elements(); ++e) {
    auto own = odd.block<3, 3>(6 * e + 3, 6 * e + 3);
    const Vector3 vector(own(2, 1), own(0, 2), own(1, 0)), torque = t.force.segment<3>(6 * e + 3);
    EXPECT_NEAR(std::fabs(vector.dot(torque)), 0.5 * torque.squaredNorm(), 1e-5 * (1 + torque.squaredNorm())) << e;
    EXPECT_NEAR(vector.norm(), 0.5 * torque.norm(), 1e-5 * (1 + torque.norm())) << e;
    torques = std::max(torques, torque.norm());
    own.setZero();
  }
  EXPECT_GT(torques, 1);
  EXPECT_LT(odd.cwiseAbs().maxCoeff(), 1e-7 * k.cwiseAbs().maxCoeff());
}

TEST(Tangent, DampingIsSymmetricAndTakesTheirPower) {
  const Simulation s = bundle();
  const Tangent t = tangent_of(s);
  const MatrixXd c = MatrixXd(t.damping);
  EXPECT_LT((c - c.transpose()).cwiseAbs().maxCoeff(), 1e-9 * c.cwiseAbs().maxCoeff());
  const VectorXd values = Eigen::SelfAdjointEigenSolver<MatrixXd>(0.5 * (c + c.transpose())).eigenvalues();
  EXPECT_GT(values.minCoeff(), -1e-9 * values.maxCoeff());
  VectorXd speed(t.mass.size());
  for (std::size_t i = 0; i < s.state().size(); ++i)
    speed.segment<6>(6 * static_cast<Eigen::Index>(i)) << s.state().velocity[i], s.state().angular_velocity[i];
  const double power = s.forces_at(s.state(), Interaction::Precision::full).damping_power;
  EXPECT_LT(power, -1);
  EXPECT_NEAR(-speed.dot(c * speed), power, 1e-9 * std::fabs(power));
}

TEST(Tangent, MovesOfTheWholeChangeNothing) {
  const Simulation s = bundle();
  const Tangent t = tangent_of(s);
  const double size = MatrixXd(t.stiffness).cwiseAbs().maxCoeff();
  for (int axis = 0; axis < 3; ++axis) {
    VectorXd shift = VectorXd::Zero(t.mass.size()), turn = shift;
    for (int e = 0; e < s.topology().elements(); ++e) {
      shift.segment<3>(6 * e) = Vector3::Unit(axis);
      turn.segment<3>(6 * e) = Vector3::Unit(axis).cross(Vector3(s.state().position[static_cast<std::size_t>(e)]));
      turn.segment<3>(6 * e + 3) = Vector3::Unit(axis);
    }
    EXPECT_LT((t.stiffness * shift).cwiseAbs().maxCoeff(), 1e-6 * size) << axis;
    EXPECT_LT((t.damping * shift).cwiseAbs().maxCoeff(), 1e-9 * size) << axis;
    EXPECT_LT((t.damping * turn).cwiseAbs().maxCoeff(), 1e-9 * size) << axis;
    // The forces turn with the rope.
    VectorXd turned = VectorXd::Zero(turn.size());
    for (int row = 0; row < turn.size(); row += 3)
      turned.segment<3>(row) = Vector3::Unit(axis).cross(Vector3(t.force.segment<3>(row)));
    EXPECT_LT((t.stiffness * turn + turned).cwiseAbs().maxCoeff(), 1e-6 * size) << axis;
  }
}

LoadsAndConstraints twisted(TwistLoad::Application application, bool lateral_free, const Topology& topology) {
  TwistLoad twist;
  twist.moment = 30;
  twist.application = application;
  twist.lateral_free = lateral_free;
  LoadsAndConstraints loads;
  add_twist(twist, topology, loads);
  return loads;
}

// Couples of fixed direction do not change; those with a potential do, and forces about the middle of a grip tie
// its elements together.
TEST(Tangent, AsksTheLoads) {
  const Tangent none = tangent_of(bundle());
  const Topology topology = bundle().topology();
  const auto with = [&](TwistLoad::Application a) { return tangent_of(bundle(twisted(a, true, topology))); };
  using A = TwistLoad::Application;
  const double size = none.stiffness.norm();
  EXPECT_LT((with(A::couple).stiffness - none.stiffness).norm(), 1e-7 * size);
  for (const A application : {A::follower, A::conservative, A::tangential}) {
    const Tangent t = with(application);
    EXPECT_GT((t.stiffness - none.stiffness).norm(), 1e-5 * size);
    EXPECT_LT(t.error, 1e-7);
  }
}

std::optional<Reduction> reduced(const Simulation& s) {
  std::string why;
  return reduction_of(s, why);
}

TEST(Reduction, LeavesOutWhatConstraintsHold) {
  const Topology topology = bundle().topology();
  LoadsAndConstraints loads;
  loads.add(FixLoad({4}, true, false, true, true));
  const auto of = reduced(bundle(loads));
  ASSERT_TRUE(of);
  const VectorXd moved = of->motions * VectorXd::Ones(of->motions.cols());
  for (Eigen::Index k = 0; k < moved.size(); ++k) EXPECT_EQ(moved[k] != 0, k / 6 != 4 || k % 6 == 1) << k;
  EXPECT_EQ(reduced(bundle(twisted(TwistLoad::Application::couple, true, topology)))->mass.size(), moved.size());
}

// The forces of a clamp that may turn and move are those of one body, and their derivative has what its elements
// press on it with.
TEST(Reduction, OfAClampIsThatOfOneBody) {
  const Topology topology = bundle().topology();
  GripLoad grip;
  grip.depth = 2;
  for (GripAxis& axis : grip.axes) axis.is = GripAxis::Is::loaded, axis.points = {{0, 3}};
  LoadsAndConstraints loads;
  loads.add(grip.on_elements({0, 1, 9, 10, 18, 19, 27, 28}, topology));
  const Simulation s = bundle(loads);
  const auto of = reduced(s);
  ASSERT_TRUE(of);
  EXPECT_EQ(of->mass.size(), 6 * (topology.elements() - 8) + 6);
  const MatrixXd k = of->forces * tangent_of(s).stiffness * of->motions + of->stiffness;
  const AllowedMotions here(s);
  const auto forces = [&](const VectorXd& u) {
    const State at = moved(s.state(), u);
    const Forces f = s.forces_at(at, Interaction::Precision::full);
    VectorXd out = load_forces(s.loads(), at);
    for (std::size_t i = 0; i < at.size(); ++i)
      out.segment<6>(6 * static_cast<Eigen::Index>(i)) +=
          (Eigen::Matrix<double, 6, 1>() << f.force[i], f.torque[i]).finished();
    // P' of the moved state: velocities f/m, constrained there.
    State there = at;
    for (std::size_t i = 0; i < at.size(); ++i) {
      const auto row = 6 * static_cast<Eigen::Index>(i);
      const VectorXd v = out.segment<6>(row).cwiseQuotient(here.mass().segment<6>(row));
      there.velocity.set(i, v.head<3>());
      there.angular_velocity.set(i, v.tail<3>());
    }
    constrain(s.topology(), s.loads(), before_all_motion, 0, there);
    for (std::size_t i = 0; i < at.size(); ++i) {
      const auto row = 6 * static_cast<Eigen::Index>(i);
      out.segment<6>(row) << there.velocity[i], there.angular_velocity[i];
      out.segment<6>(row) = out.segment<6>(row).cwiseProduct(here.mass().segment<6>(row)).eval();
    }
    return VectorXd(of->forces * out);
  };
  constexpr double h = 1e-5;
  const VectorXd q = random_motion(of->mass.size(), 3), u = of->motions * q;
  const VectorXd change = -(forces(h * u) - forces(-h * u)) / (2 * h);
  EXPECT_LT((k * q - change).norm(), 1e-6 * change.norm());
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
