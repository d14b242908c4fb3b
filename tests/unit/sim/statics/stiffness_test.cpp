// Blocks of the tangent against differences of the program's own forces.
#include "sim/statics/stiffness.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "scene/ends/grip.hpp"
#include "scene/ends/twist.hpp"
#include "scene/loads/force.hpp"
#include "scene/loads/torque.hpp"
#include "scene/prepare.hpp"
#include "scene/scene_toml.hpp"
#include "sim/contact/line/law.hpp"
#include "sim/contact/paper/law.hpp"
#include "sim/dynamics/tangent.hpp"
#include "sim/forces/terms/tube_ends.hpp"
#include "unit/support.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

using Eigen::VectorXd;
using Application = TwistLoad::Application;

Interaction with_law(std::shared_ptr<const ContactLaw> law) {
  Interaction in;
  in.law = std::move(law);
  return in;
}
std::shared_ptr<const ContactLaw> line(int nodes = 5) {
  return line_law({test::line_contact(0.6785, nodes, 0.6785, nodes)});
}

struct Built {
  Topology topology;
  State state;
};
Built bundle(double spacing = 1.72, double disorder = 0.03, BondStiffness bond = test::published_bond()) {
  Built b;
  b.topology = test::published_topology();
  b.topology.types[0].bond = bond;
  b.state = test::disordered_bundle(b.topology, 4, 9, spacing, disorder, 3);
  b.state.velocity.set_to_zero();
  b.state.angular_velocity.set_to_zero();
  return b;
}
Simulation simulation(const Built& b, Interaction in, LoadsAndConstraints loads = {}) {
  return Simulation(b.topology, std::move(in), std::move(loads), b.state, 0.01);
}

VectorXd forces_of(const Simulation& s, const State& at) {
  const Forces f = s.forces_at(at, Interaction::Precision::full);
  VectorXd out = load_forces(s.loads(), at);
  for (std::size_t i = 0; i < at.size(); ++i)
    out.segment<6>(6 * static_cast<Eigen::Index>(i)) +=
        (Eigen::Matrix<double, 6, 1>() << f.force[i], f.torque[i]).finished();
  return out;
}

// The part by which K x and the change of the forces along x differ, of random motions of all elements.
double error_of(const Simulation& s) {
  constexpr double h = 1e-5;
  StiffnessMaker maker(s);
  BlockMatrix k = maker.make(s);
  add_left_torque(forces_of(s, s.state()), k);
  double worst = 0;
  for (unsigned seed = 1; seed <= 3; ++seed) {
    test::Random random(seed);
    VectorXd x(6 * static_cast<Eigen::Index>(s.state().size())), y;
    for (Eigen::Index q = 0; q < x.size(); ++q) x[q] = random.uniform(-1, 1);
    const auto at = [&](double by) { return forces_of(s, moved(s.state(), by * x)); };
    const VectorXd change = -(8 * (at(h) - at(-h)) - (at(2 * h) - at(-2 * h))) / (12 * h);
    k.multiply(x, y);
    worst = std::max(worst, (y - change).norm() / change.norm());
  }
  return worst;
}

TEST(Stiffness, OfBonds) {
  EXPECT_LT(error_of(simulation(bundle(), {})), 1e-9);
  // Inside of the window, at its edges and beyond them; without and with a law of stretch beyond it.
  for (const BondStiffness& bond : {test::anharmonic_bond(), test::pulled_bond()})
    for (const double disorder : {0.003, 0.03, 0.1})
      EXPECT_LT(error_of(simulation(bundle(1.72, disorder, bond), {})), disorder < 0.01 ? 1e-8 : 1e-7) << disorder;
}

// The polynomials of the table have steps in their second derivative where they meet, of 1e-7 of the largest one.
TEST(Stiffness, OfTheLineLaw) {
  for (const int nodes : {1, 4, 5, 6, 9})
    EXPECT_LT(error_of(simulation(bundle(), with_law(line(nodes)))), 1e-8) << nodes;
  // The law's own third derivative has a step at the core.
  EXPECT_LT(error_of(simulation(bundle(1.5), with_law(line()))), 1e-5) << "inside of the core";
}

TEST(Stiffness, OfTwoTypesOfTubes) {
  Built b = bundle();
  b.topology.types.push_back(b.topology.types[0]);
  b.topology.types[1].radius = 0.5;
  b.topology.tube_type[1] = b.topology.tube_type[3] = 1;
  const auto law = line_law({test::line_contact(0.6785, 4, 0.6785, 4), test::line_contact(0.6785, 4, 0.5, 6),
                             test::line_contact(0.5, 6, 0.6785, 4), test::line_contact(0.5, 6, 0.5, 6)});
  EXPECT_LT(error_of(simulation(b, with_law(law))), 1e-8);
}

TEST(Stiffness, OfThePaperLaw) {
  EXPECT_LT(error_of(simulation(bundle(), with_law(paper_law(test::published_contact())))), 1e-6);
}

TEST(Stiffness, OfCouplesOnTheGrips) {
  for (const Application a :
       {Application::couple, Application::follower, Application::conservative, Application::tangential}) {
    const Built b = bundle();
    TwistLoad twist;
    twist.moment = 30;
    twist.application = a;
    LoadsAndConstraints loads;
    add_twist(twist, b.topology, loads);
    const Simulation s = simulation(b, with_law(line()), loads);
    EXPECT_LT(error_of(s), 1e-8) << static_cast<int>(a);
    StiffnessMaker maker(s);
    EXPECT_EQ(maker.make(s).symmetric(), a == Application::conservative) << static_cast<int>(a);
  }
}

TEST(Stiffness, OfForcesCouplesAndClamps) {
  const Built b = bundle();
  LoadsAndConstraints loads;
  ForceLoad force;
  force.elements = {3, 12};
  force.force = {1, -2, 0.5};
  loads.add(force);
  const Simulation pulled = simulation(b, with_law(line()), loads);
  EXPECT_LT(error_of(pulled), 1e-8);
  StiffnessMaker maker(pulled);
  EXPECT_TRUE(maker.make(pulled).symmetric());
  TorqueLoad torque;
  torque.elements = {8};
  torque.torque = {0, 3, 20};
  loads.add(torque);
  GripLoad grip;
  grip.depth = 2;
  for (GripAxis& axis : grip.axes) {
    axis.is = GripAxis::Is::loaded;
    axis.points = {{0, 4}};
  }
  loads.add(grip.on_elements({7, 8, 16, 17, 25, 26, 34, 35}, b.topology));
  EXPECT_LT(error_of(simulation(b, with_law(line()), loads)), 1e-8);
}

TEST(Stiffness, OfEndsOfTubes) {
  Built b;
  b.topology = test::published_topology();
  const LennardJones lj{0.00284, 0.34, 1.2};
  const TubeEnd end = tube_end({10, 10}, 0.678, 40 / 0.246);
  b.topology.add_tube(4);
  b.topology.add_tube(4);
  b.topology.groups.strand_begin = {0, 2};
  b.topology.groups.ends_meet = true;
  b.state = State(8);
  test::Random random(5);
  for (int e = 0; e < 8; ++e) {
    const auto i = static_cast<std::size_t>(e);
    b.state.position.set(i,
                         Vector3(0, 0, e * test::element_length + (e > 3 ? 0.33 : 0)) + 0.02 * random.direction());
    b.state.orientation.set(i, test::turn(random.direction(), 0.02));
  }
  Interaction in;
  add_term(tube_ends_term({EndContact(lj, end, end)}, b.topology), in);
  Simulation with = simulation(b, in), without = simulation(b, {});
  EXPECT_LT(error_of(with), 1e-8);
  StiffnessMaker maker(with), plain(without);
  const Block block = maker.make(with).diagonal[3] - plain.make(without).diagonal[3];
  EXPECT_GT(block.norm(), 1e-3);
}

// Stretched and pressed; between tubes, inside of one and to a point; held by several elements at an end.
TEST(Stiffness, OfTethers) {
  const std::string rope =
      "format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-tersoff\"\n[rope]\ntubes = 7\nlength_nm = 13.6\n"
      "[run]\nmode = \"relax\"\n";
  const std::string tethers =
      "[[tether]]\ntube = 0\nelements = [1, 2, 5]\nto_tube = 1\nto_elements = [3, 8]\nstiffness_nN_per_nm = 3\n"
      "rest_nm = 0.5\n"
      "[[tether]]\ntube = 2\nelements = [2, 4]\nto_tube = 2\nto_elements = [4, 9]\nstiffness_nN_per_nm = 2\n"
      "rest_nm = 7\n"
      "[[tether]]\ntube = 1\nelements = [-1]\nto_point_nm = [3, 1, 20]\nstiffness_nN_per_nm = 5\nrest_nm = 3\n";
  const auto made = [](const std::string& text) {
    Scene scene = scene_of_text(text, "scene.toml");
    return start(scene, prepare(scene));
  };
  const Simulation with = made(rope + tethers), without = made(rope);
  EXPECT_LT(error_of(with), 1e-8);
  StiffnessMaker maker(with), plain(without);
  const VectorXd x = VectorXd::LinSpaced(6 * static_cast<Eigen::Index>(with.state().size()), -1, 2);
  VectorXd y, z;
  maker.make(with).multiply(x, y);
  plain.make(without).multiply(x, z);
  EXPECT_GT((y - z).norm(), 1);
}

class NoTangent : public ForceTerm {
 public:
  std::unique_ptr<ForceTerm> copy() const override { return std::make_unique<NoTangent>(*this); }
  std::string name() const override { return "plain"; }
};

TEST(Stiffness, ATermWithoutATangentIsNamed) {
  Interaction in;
  add_term(std::make_shared<NoTangent>(), in);
  const Simulation s = simulation(bundle(), in);
  EXPECT_EQ(term_without_tangent(s), "plain");
  StiffnessMaker maker(s);
  EXPECT_THROW(maker.make(s), std::runtime_error);
  EXPECT_EQ(term_without_tangent(simulation(bundle(), {})), "");
}

TEST(Stiffness, IsThatOfDifferencesOfAllForces) {
  const Built b = bundle();
  Interaction in = with_law(line());
  in.damping.contact = {20, 1.7, 2.6};
  TwistLoad twist;
  twist.moment = 30;
  twist.application = Application::tangential;
  LoadsAndConstraints loads;
  add_twist(twist, b.topology, loads);
  const Simulation s = simulation(b, in, loads);
  const Tangent blocks = tangent_by_blocks(s), differences = tangent_of(s);
  EXPECT_LT((blocks.stiffness - differences.stiffness).norm(), 1e-7 * differences.stiffness.norm());
  EXPECT_LT((blocks.damping - differences.damping).norm(), 1e-9 * differences.damping.norm());
  EXPECT_LT(blocks.error, 1e-7);
  EXPECT_LT(blocks.evaluations, differences.evaluations);
}

// As Eigen's matrices have it.
TEST(BlockMatrix, ProductsAreThoseOfTheSparseMatrix) {
  const Built b = bundle();
  TwistLoad twist;
  twist.moment = 30;
  twist.application = Application::tangential;
  LoadsAndConstraints loads;
  add_twist(twist, b.topology, loads);
  const Simulation s = simulation(b, with_law(line()), loads);
  StiffnessMaker maker(s);
  const BlockMatrix& k = maker.make(s);
  const VectorXd x = VectorXd::LinSpaced(6 * k.rows(), -1, 2);
  VectorXd y;
  k.multiply(x, y);
  EXPECT_LT((k.sparse() * x - y).norm(), 1e-12 * y.norm());
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
