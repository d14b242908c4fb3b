// States of rest by Newton's method against closed forms and against FIRE.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "model/error.hpp"
#include "observe/loading.hpp"
#include "run/moving_scene.hpp"
#include "scene/ends/grip.hpp"
#include "scene/ends/periodic.hpp"
#include "scene/ends/twist.hpp"
#include "scene/loads/fix.hpp"
#include "scene/loads/force.hpp"
#include "scene/loads/torque.hpp"
#include "scene/prepare.hpp"
#include "scene/scene_toml.hpp"
#include "sim/contact/line/law.hpp"
#include "sim/statics/end_words.hpp"
#include "sim/statics/newton.hpp"
#include "sim/statics/reduction.hpp"
#include "sim/statics/stability.hpp"
#include "sim/statics/stiffness.hpp"
#include "unit/support.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

using test::element_length;

const auto go_on = [](long) { return true; };

struct Beam {
  Topology topology = test::published_topology();
  LoadsAndConstraints loads;
  State state;
  int last = 0;

  explicit Beam(int elements) {
    topology.add_tube(elements);
    state = State(static_cast<std::size_t>(elements));
    for (int i = 0; i < elements; ++i) state.position.set(i, {0, 0, i * element_length});
    last = elements - 1;
  }
  double length() const { return last * element_length; }
  const BondStiffness& bond() const { return topology.types[0].bond; }
  Simulation make() const { return Simulation(topology, {}, loads, state, 0.01); }
};

Statics rest(Simulation& s, const RelaxGoal& goal = {1e-7, 1e-5}) {
  return NewtonStatics(s).relax(goal, 1000, go_on);
}

TEST(Statics, CantileverTakesAFewSteps) {
  Beam b(61);
  const double force = 1e-3;  // eV/nm
  b.loads.add(FixLoad({0}));
  b.loads.add(ForceLoad({b.last}, {force, 0, 0}));
  Simulation s = b.make();
  const Statics end = rest(s);
  ASSERT_TRUE(end.relaxed.at_rest);
  EXPECT_LT(end.newton_steps, 40);
  EXPECT_TRUE(end.symmetric);
  EXPECT_FALSE(end.falls);
  const double expected = force * std::pow(b.length(), 3) / (3 * b.bond().bend);
  EXPECT_NEAR(s.state().position[b.last].x() / expected, 1, 2e-4);
  EXPECT_NEAR(s.work() / (2 * s.forces().energy.bonds()), 1, 1e-3);
}

// The inextensible elastica under a dead end force P L^2/EI = 1, 4, 10: sideways and along, of the length.
// K. E. Bisshopp, D. C. Drucker, Q. Appl. Math. 3, 272 (1945), DOI 10.1090/qam/13360. Here again by a shooting of
// theta'' = -(P/EI) cos(theta).
struct Elastica {
  double sideways = 0, along = 0;
};
Elastica elastica(double load) {
  constexpr int steps = 4000;
  const auto shot = [&](double curvature, Elastica* out) {
    double theta = 0, bend = curvature;
    const double h = 1.0 / steps;
    const auto slope = [&](double t) { return -load * std::cos(t); };
    for (int k = 0; k < steps; ++k) {
      const double k1 = bend, l1 = slope(theta), k2 = bend + 0.5 * h * l1, l2 = slope(theta + 0.5 * h * k1),
                   k3 = bend + 0.5 * h * l2, l3 = slope(theta + 0.5 * h * k2), k4 = bend + h * l3,
                   l4 = slope(theta + h * k3);
      const double next = theta + h * (k1 + 2 * k2 + 2 * k3 + k4) / 6, middle = theta + 0.5 * h * bend;
      if (out) {
        out->sideways += h * (std::sin(theta) + 4 * std::sin(middle) + std::sin(next)) / 6;
        out->along += h * (std::cos(theta) + 4 * std::cos(middle) + std::cos(next)) / 6;
      }
      theta = next;
      bend += h * (l1 + 2 * l2 + 2 * l3 + l4) / 6;
    }
    return bend;  // zero at the free end
  };
  double low = 0, high = load;
  for (int k = 0; k < 60; ++k) (shot(0.5 * (low + high), nullptr) > 0 ? high : low) = 0.5 * (low + high);
  Elastica out;
  shot(0.5 * (low + high), &out);
  return out;
}

TEST(Statics, CantileverThatBendsFarIsTheElastica) {
  EXPECT_NEAR(elastica(1).sideways, 0.3017, 1e-4);  // as Bisshopp and Drucker have it
  EXPECT_NEAR(elastica(10).along, 0.4450, 1e-4);
  for (const double load : {1.0, 4.0, 10.0}) {
    Beam b(101);
    b.topology.types[0].bond.stretch *= 100;
    b.loads.add(FixLoad({0}));
    b.loads.add(ForceLoad({b.last}, {load * b.bond().bend / (b.length() * b.length()), 0, 0}));
    Simulation s = b.make();
    ASSERT_TRUE(rest(s).relaxed.at_rest) << load;
    const Elastica expected = elastica(load);
    EXPECT_NEAR(s.state().position[b.last].x() / b.length(), expected.sideways, 2e-4) << load;
    EXPECT_NEAR(s.state().position[b.last].z() / b.length(), expected.along, 2e-4) << load;
  }
}

// The torque of a bond is GJ/a sin(phi). Only the ends' couples are along the tube: nothing else holds its spin.
TEST(Statics, TubeBetweenCouplesTwistsAsItsBonds) {
  Beam b(21);
  const double moment = 100;  // eV
  TwistLoad twist;
  twist.moment = moment;
  add_twist(twist, b.topology, b.loads);
  Simulation s = b.make();
  const Statics end = rest(s);
  ASSERT_TRUE(end.relaxed.at_rest);
  EXPECT_FALSE(end.symmetric);
  EXPECT_LT(end.spinning, 1e-9);
  const double each = std::asin(moment * element_length / b.bond().twist);
  for (int e = 0; e < b.last; ++e)
    EXPECT_NEAR(bond_twist_angle(frame_of(s.state().orientation[e]), frame_of(s.state().orientation[e + 1])), each,
                1e-7);
}

// From straight to the helix of its natural curvature and twist.
TEST(Statics, AFilamentFindsItsNaturalHelix) {
  Beam b(31);
  b.topology.types[0].bond = test::shaped_bond();
  Simulation s = b.make();
  ASSERT_GT(s.forces().energy.bonds(), 100);
  ASSERT_TRUE(rest(s).relaxed.at_rest);
  EXPECT_LT(s.forces().energy.bonds(), 1e-8);
  for (int e = 0; e < b.last; ++e) {
    const Quaternion turn = s.state().orientation[e].conjugate() * s.state().orientation[e + 1];
    EXPECT_LT(turn.angularDistance(natural_turn(b.bond(), element_length)), 1e-5) << e;
  }
}

// No wave of a filament at its natural shape is faster than the time step allows, and the step is not much shorter.
TEST(Statics, TheTimeStepKnowsTheNaturalShape) {
  const forms::Vec shapes[] = {{0, 0, 0}, {0.15, -0.1, 0.3}, {0.6, 0, 0.5}, {0.8, 0.7, 0}, {0, 0, 1.1}};
  for (const forms::Vec& shape : shapes)
    for (const double difference : {0.0, 0.6}) {
      Beam b(24);
      BondStiffness& k = b.topology.types[0].bond;
      k.natural = shape;
      k.bend_difference = difference * k.bend;
      for (int i = 1; i <= b.last; ++i) {
        const Quaternion before = b.state.orientation[i - 1];
        b.state.position.set(i, b.state.position[i - 1] +
                                    element_length * (before * natural_turn(k, 0.5 * element_length) * Vector3::UnitZ()));
        b.state.orientation.set(i, before * natural_turn(k, element_length));
      }
      const Simulation s = b.make();
      ASSERT_LT(s.forces().energy.bonds(), 1e-10);
      const Tangent t = tangent_of(s);
      const Eigen::VectorXd per_mass = t.mass.cwiseSqrt().cwiseInverse();
      const Eigen::MatrixXd m = per_mass.asDiagonal() * Eigen::MatrixXd(t.stiffness) * per_mass.asDiagonal();
      const double fastest = std::sqrt(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(0.5 * (m + m.transpose())).eigenvalues().maxCoeff());
      const double allowed = 2 / time_step_limit(b.topology, {}, 0).limit;
      EXPECT_LT(fastest, 1.0001 * allowed) << shape.x << " " << difference;
      EXPECT_GT(fastest, 0.9 * allowed) << shape.x << " " << difference;
      RecordProperty("margin", std::to_string(allowed / fastest));
    }
}

// The tangent of bonds of a natural shape, bent, against differences of their forces.
TEST(Statics, TangentOfShapedBondsIsThatOfDifferences) {
  Topology topology = test::published_topology();
  topology.types[0].bond = test::shaped_bond();
  const State state = test::disordered_bundle(topology, 2, 9, 1.75, 0.1, 4);
  const Simulation s(topology, {}, {}, state, 0.002);
  EXPECT_LT(tangent_by_blocks(s).error, 1e-6);
}

TEST(Statics, AFreeTubeWithoutForcesIsAtRest) {
  Simulation s = Beam(10).make();
  const Statics end = rest(s, {});
  EXPECT_TRUE(end.relaxed.at_rest);
  EXPECT_LT(end.newton_steps, 30);
}

// Straight to the last bit: no force acts sideways.
Beam column(double part_of_buckling_load) {
  Beam b(31);
  b.loads.add(FixLoad({0}, true, true, true, false));
  b.loads.add(FixLoad({b.last}, true, true, false, false));
  const double euler = units::pi * units::pi * b.bond().bend / (b.length() * b.length());
  b.loads.add(ForceLoad({b.last}, {0, 0, -part_of_buckling_load * euler}));
  return b;
}

TEST(Statics, ColumnLeavesItsStraightStateAboveTheEulerLoad) {
  for (const double part : {0.98, 1.02}) {
    const Beam b = column(part);
    Simulation s = b.make();
    const Statics end = rest(s, {});
    ASSERT_TRUE(end.relaxed.at_rest) << part;
    EXPECT_FALSE(end.falls) << part;
    EXPECT_EQ(end.relaxed.saddles, part > 1 ? 1 : 0) << part;
    // P/Pc = 1 + slope^2/8 with the slope at the ends, and bow = slope L/pi.
    const double expected = part > 1 ? std::sqrt(8 * (part - 1)) * b.length() / units::pi : 0;
    EXPECT_NEAR(s.state().position[15].head<2>().norm(), expected, 0.1 * expected + 1e-4) << part;
  }
}

// Again and again, and each time read from its bytes by another simulation.
TEST(Statics, InterruptedGoesOnToTheSameBits) {
  const Beam b = column(1.1);
  for (const bool fire : {false, true}) {
    const NewtonOptions options{fire};
    Simulation whole = b.make(), s = b.make();
    ASSERT_EQ(NewtonStatics(whole, options).relax({}, 4000, go_on).relaxed.saddles, 1);
    for (int interruptions = 0;; ++interruptions) {
      ASSERT_LT(interruptions, 1000);
      int steps = 0;
      if (NewtonStatics(s, options).relax({}, 4000, [&](long) { return steps++ < 3; }).relaxed.at_rest) break;
      Simulation other = b.make();
      other.restore(s.serialise());
      s = std::move(other);
    }
    EXPECT_TRUE(s.serialise() == whole.serialise()) << fire;
    // At rest it says the same again.
    Simulation again = b.make();
    again.restore(s.serialise());
    const Statics end = NewtonStatics(again, options).relax({}, 4000, go_on);
    EXPECT_TRUE(end.relaxed.at_rest);
    EXPECT_EQ(end.relaxed.saddles, 1);
    EXPECT_TRUE(again.serialise() == whole.serialise()) << fire;
  }
}

// Seven tubes that touch, with a clamp of two elements of each tube at both ends.
struct Rope {
  Topology topology = test::published_topology();
  Interaction in;
  LoadsAndConstraints loads;
  State state;

  explicit Rope(int elements, int tubes = 7, double disorder = 0.02) {
    topology.types[0].bond = test::anharmonic_bond();
    topology.types[0].bond.anharmonic.max_shear = topology.types[0].bond.anharmonic.max_bend = 1;
    state = test::disordered_bundle(topology, tubes, elements, 1.7, disorder, 3);
    state.velocity.set_to_zero();
    state.angular_velocity.set_to_zero();
    in.law = line_law({test::line_contact(0.6785, 5, 0.6785, 5)});
    in.damping.contact = {20, 1.7, 2.6};  // has no part in it
  }
  std::vector<int> end(End which) const {
    std::vector<int> out;
    for (int t = 0; t < topology.tubes(); ++t)
      for (int k = 0; k < 2; ++k)
        out.push_back(which == lower_end ? topology.tube_begin[t] + k : topology.tube_begin[t + 1] - 2 + k);
    return out;
  }
  Simulation make() const { return Simulation(topology, in, loads, state, 0.002); }
};

GripLoad clamp(End end) {
  GripLoad grip;
  grip.end = end;
  grip.depth = 2;
  return grip;
}

TEST(Statics, ClampedRopeEndsAsByFire) {
  Rope rope(8, 4);
  GripLoad pulled = clamp(upper_end);
  for (const std::size_t axis : {0u, 2u, 3u}) {
    pulled.axes[axis].is = GripAxis::Is::loaded;
    pulled.axes[axis].points = {{0, axis == 2 ? 20.0 : 1.5}};
  }
  rope.loads.add(clamp(lower_end).on_elements(rope.end(lower_end), rope.topology));
  rope.loads.add(pulled.on_elements(rope.end(upper_end), rope.topology));
  Simulation by_fire = rope.make(), s = rope.make();
  ASSERT_TRUE(by_fire.relax(RelaxGoal{1e-5, 1e-4}, 100000, go_on).at_rest);
  const Statics end = rest(s, {1e-5, 1e-4});
  ASSERT_TRUE(end.relaxed.at_rest);
  EXPECT_LT(end.newton_steps, 60);
  const double of_fire = by_fire.forces().energy.potential() - by_fire.work(),
               of_newton = s.forces().energy.potential() - s.work();
  EXPECT_NEAR(of_newton, of_fire, 1e-4);
  EXPECT_LT(s.largest_force(), 1e-5);
}

// With steps that grow small as their squares: the tangent is the derivative of the forces, couples included.
TEST(Statics, TwistedRopeComesToRest) {
  Rope rope(12);
  TwistLoad twist;
  twist.moment = 80;
  add_twist(twist, rope.topology, rope.loads);
  Simulation s = rope.make();
  const double before = s.total_energy() - s.account().supplied();
  const Statics end = rest(s, {1e-6, 1e-5});
  ASSERT_TRUE(end.relaxed.at_rest);
  EXPECT_FALSE(end.symmetric);
  EXPECT_LT(end.newton_steps, 80);
  EXPECT_NEAR(s.total_energy() - s.account().supplied(), before, 1e-9) << "the account of energy holds";
  EXPECT_GT(s.forces().energy.twist, 1);
}

// The sections of a rope take what reaches far: its bends, and its twist with the tilts of the tubes that go with
// it. Without those tilts a step takes 136 products.
TEST(Statics, ALongRopeTakesFewStepsOfFewProducts) {
  Rope rope(80, 7, 0.0);
  rope.in.law = line_law({test::line_contact(0.6785, 8, 0.6785, 8)});
  TwistLoad twist;
  twist.moment = 60;
  add_twist(twist, rope.topology, rope.loads);
  Simulation s = rope.make();
  const Statics end = rest(s, {1e-4, 1e-3});
  ASSERT_TRUE(end.relaxed.at_rest);
  EXPECT_LT(static_cast<double>(end.products) / end.newton_steps, 50);
  EXPECT_LT(end.newton_steps, 24) << "turns of its sections shear the tubes, or bound the steps";
}

// Force times slope at the ends is the energy that a length of contact gives back, whatever the shape of the crack.
// The start: cantilevers in balance with the cohesion. They are held in the plane, since two tubes that touch wind
// about one another where they may.
TEST(Statics, TwoTubesThatPartGiveBackTheirCohesion) {
  constexpr int n = 45;
  constexpr double opening = 2;  // nm, of each end
  Rope rope(n, 2, 0);
  rope.topology.types[0].bond = test::published_bond();
  const BondStiffness& bond = rope.topology.types[0].bond;
  const auto energy = [&](int elements, double apart) {
    Rope pair(elements, 2, 0);
    for (int e = 0; e < 2 * elements; ++e)
      pair.state.position.set(static_cast<std::size_t>(e),
                              {e < elements ? 0 : apart, 0, e % elements * element_length});
    return pair.make().forces().energy.vdw;
  };
  const double spacing = rope.in.law->parallel_distance({0, 0}, element_length);
  double cohesion = 0;  // of a length of two straight tubes, at their best distance
  for (double more = -0.02; more < 0.021; more += 0.005)
    cohesion =
        std::max(cohesion, (energy(20, spacing + more) - energy(30, spacing + more)) / (10 * element_length));
  const double crack = std::pow(9 * bond.bend * opening * opening / cohesion, 0.25);
  ASSERT_LT(crack, 0.5 * n * element_length);
  for (int t = 0; t < 2; ++t) {
    const double side = t == 0 ? -1 : 1;
    for (int e = 0; e < n; ++e) {
      const auto i = static_cast<std::size_t>(t * n + e);
      const double z = e * element_length, s = std::min(1.0, z / crack);
      rope.state.position.set(i, {side * (0.5 * spacing + opening * (1 - 1.5 * s + 0.5 * s * s * s)), 0, z});
      rope.state.orientation.set(
          i, test::turn(Vector3::UnitY(), std::atan(side * opening / crack * (1.5 * s * s - 1.5))));
    }
    rope.loads.add(FixLoad({t * n}, true, false, false, false));
    rope.loads.add(FixLoad({(t + 1) * n - 1}, false, false, true, false));
  }
  std::vector<int> all(rope.state.size());
  std::iota(all.begin(), all.end(), 0);
  rope.loads.add(FixLoad(all, false, true, false, false));
  Simulation s = rope.make();
  const Statics end = rest(s, {1e-6, 1e-5});
  ASSERT_TRUE(end.relaxed.at_rest);
  double release = 0;
  for (const std::size_t i : {std::size_t{0}, static_cast<std::size_t>(n)})
    release += std::fabs(s.forces().force.x[i] * axis_of(s.state().orientation[i]).x());
  EXPECT_NEAR(release, cohesion, 0.002 * cohesion);
}

GripLoad moved_by(std::size_t axis, std::vector<Schedule::Point> points, int depth) {
  GripLoad grip;
  grip.depth = depth;
  grip.axes[axis].is = GripAxis::Is::moved;
  grip.axes[axis].points = std::move(points);
  return grip;
}

// Far from rest at once, and in steps that a bond bears. The work of the clamp is what the bonds hold.
TEST(Statics, TubeFollowsAClampThatTurnsAndDraws) {
  constexpr double angle = 1.5, draw = 0.3;
  Beam b(21);
  GripLoad lower;
  lower.end = lower_end;
  b.loads.add(lower.on_elements({0}, b.topology));
  GripLoad upper = moved_by(GripLoad::about_z, {{0, 0}, {10, angle}}, 1);
  upper.axes[GripLoad::z].is = GripAxis::Is::moved;
  upper.axes[GripLoad::z].points = {{5, 0}, {10, draw}};
  b.loads.add(upper.on_elements({b.last}, b.topology));
  Simulation s = b.make();
  const RelaxGoal goal{1e-7, 1e-6};
  NewtonStatics newton(s);
  ASSERT_EQ(newton.follow(10, goal, go_on).end, Statics::End::at_rest);
  ASSERT_TRUE(newton.relax(goal, 100, go_on).relaxed.at_rest);
  EXPECT_EQ(s.time(), 10);
  const double each = angle / b.last, longer = draw / b.last;
  for (int e = 0; e < b.last; ++e) {
    EXPECT_NEAR(bond_twist_angle(frame_of(s.state().orientation[e]), frame_of(s.state().orientation[e + 1])), each,
                1e-8);
    EXPECT_NEAR((s.state().position[e + 1] - s.state().position[e]).norm(), element_length + longer, 1e-8);
  }
  EXPECT_NEAR(s.work(), s.forces().energy.potential(), 2e-3 * s.work());
  const EndReadings ends = s.read_gauges();
  EXPECT_NEAR(ends[upper_end].torque.z(), b.bond().twist / element_length * std::sin(each), 1e-5);
  EXPECT_NEAR(ends[upper_end].turned, angle, 1e-9);
  EXPECT_NEAR(ends[upper_end].work, s.work(), 1e-6);
}

// The state of rest of a rope between clamps does not depend on the steps to it, and back it is the first one.
TEST(Statics, RopeFollowsAClampThereAndBack) {
  Rope rope(12, 7, 0);
  rope.loads.add(clamp(lower_end).on_elements(rope.end(lower_end), rope.topology));
  const GripLoad turned = moved_by(GripLoad::about_z, {{0, 0}, {10, 0.4}, {20, 0}}, 2);
  rope.loads.add(turned.on_elements(rope.end(upper_end), rope.topology));
  const RelaxGoal goal{1e-6, 1e-5};
  const auto energies = [&](const std::vector<double>& times) {
    Simulation s = rope.make();
    NewtonStatics newton(s);
    std::vector<double> out;
    double work = 0;
    for (const double time : times) {
      EXPECT_EQ(newton.follow(time, goal, go_on).end, Statics::End::at_rest) << time;
      EXPECT_TRUE(newton.relax(goal, 200, go_on).relaxed.at_rest) << time;
      if (out.empty()) work = s.work();
      out.push_back(s.forces().energy.potential());
    }
    // What the clamp puts in on the way it gets back.
    EXPECT_NEAR(s.work() - work, out.back() - out.front(), 0.02 * (out[out.size() / 2] - out.front()));
    return out;
  };
  const std::vector<double> few = energies({0, 10, 20}), many = energies({0, 3, 6, 10, 15, 20});
  EXPECT_GT(few[1] - few[0], 1);
  EXPECT_NEAR(few[1], many[3], 1e-5);
  EXPECT_NEAR(few[2], few[0], 1e-5);
  EXPECT_NEAR(many[5], few[0], 1e-5);
}

// A closed ring whose twist its ends keep: the first and the last element are one. A motion out of its plane grows
// where the couple in it is above sqrt(3) EI/R, that is above a twist of 2 pi sqrt(3) EI/GJ. J. H. Michell,
// Messenger of Math. 19, 181 (1890).
TEST(Statics, TwistedRingIsUnstableAsMichellHasIt) {
  constexpr int bonds = 140;
  const double around = 2 * units::pi / bonds;
  for (const double part : {0.96, 1.1, 1.3}) {
    Beam b(bonds + 1);
    const double critical = 2 * units::pi * std::sqrt(3.0) * b.bond().bend / b.bond().twist,
                 each = std::asin(part * critical / bonds), radius = 0.5 * element_length / std::sin(0.5 * around);
    for (int e = 0; e <= b.last; ++e) {
      const auto i = static_cast<std::size_t>(e);
      const Quaternion place = test::turn(Vector3::UnitZ(), e * around);
      b.state.position.set(i, place * Vector3(radius, 0, 0));
      b.state.orientation.set(
          i, place * test::turn(Vector3::UnitX(), -0.5 * units::pi) * test::turn(Vector3::UnitZ(), e * each));
    }
    GripLoad joint;
    joint.depth = 2;
    for (GripAxis& axis : joint.axes) axis.is = GripAxis::Is::free;
    b.loads.add(joint.on_elements({0, b.last}, b.topology));
    Simulation s = b.make();
    const RelaxGoal goal{1e-6, 1e-5};
    NewtonOptions stay;
    stay.slow = 1;
    const Statics circle = NewtonStatics(s, stay).relax(goal, 300, go_on);
    ASSERT_TRUE(circle.relaxed.at_rest) << part;
    const StabilityVerdict verdict = judge_stability(s, circle);
    EXPECT_EQ(verdict.kind, part < 1 ? StabilityVerdict::Kind::stable : StabilityVerdict::Kind::unstable)
        << part << ": " << verdict.words();
    const double energy = s.forces().energy.potential();
    s = b.make();
    const Statics end = NewtonStatics(s).relax(goal, 300, go_on);
    ASSERT_TRUE(end.relaxed.at_rest) << part;
    EXPECT_EQ(judge_stability(s, end).kind, StabilityVerdict::Kind::stable) << part;
    EXPECT_EQ(end.relaxed.saddles, part < 1 ? 0 : 1) << part;
    // It writhes, and keeps a quarter of the energy.
    if (part > 1) {
      EXPECT_LT(s.forces().energy.potential(), 0.3 * energy) << part;
    }
  }
}

// --- slices of an endless rope ---------------------------------------------------------------------------------

std::string slice_text(const std::string& periodic, const std::string& more = "") {
  return "format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-tersoff\"\n[rope]\ntubes = 7\nlength_nm = "
         "22.0413\n"
         "[contact]\nprecision = \"double\"\n[periodic]\n" +
         periodic + more;
}
struct Slice {
  Scene scene;
  Prepared p;

  explicit Slice(const std::string& text) : scene(scene_of_text(text, "slice.toml")), p(prepare(scene)) {}
  Simulation make() const { return start(scene, p); }
};
const std::string by_newton = "[run]\nmode = \"relax\"\nsolver = \"newton\"\n";

State shaken(const State& state, double by) {
  test::Random random(4);
  State out = state;
  for (std::size_t i = 0; i < out.size(); ++i) {
    out.position.add(i, by * random.direction());
    out.orientation.set(i, (test::turn(random.direction(), by) * out.orientation[i]).normalized());
  }
  return out;
}

// The tangent of a slice is symmetric, so that it is that of an energy, and the derivative of its forces: on its
// own elements, and on its period where that is free.
TEST(Statics, TangentOfASliceIsThatOfAnEnergy) {
  for (const char* tension : {"", "tension_nN = [[0, 20]]\n"}) {
    Slice slice(slice_text("twist_deg_per_nm = [[0, 1.5]]\n" + std::string(tension), by_newton));
    slice.p.state = shaken(slice.p.state, 0.03);
    slice.p.loads.of<PeriodicLoad>().front()->place(slice.p.topology, slice.p.state);
    const Simulation s = slice.make();
    std::string why;
    const auto of = reduction_of(s, why);
    ASSERT_TRUE(of) << why;
    EXPECT_EQ(of->mass.size() % 6, *tension ? 1 : 0);
    StiffnessMaker maker(s);
    BlockMatrix blocks = maker.make(s);
    const Eigen::MatrixXd k = of->forces * blocks.sparse() * of->motions;
    // The images reach as far as the contact, but for a part of an element at whose distance it is weak.
    EXPECT_LT((k - k.transpose()).norm(), 1e-5 * k.norm()) << tension;
    Eigen::VectorXd total(6 * static_cast<Eigen::Index>(s.state().size()));
    const auto forces = [&](const State& at) {
      const Forces f = s.forces_at(at, Interaction::Precision::full);
      for (std::size_t i = 0; i < at.size(); ++i)
        total.segment<6>(6 * static_cast<Eigen::Index>(i)) << f.force[i], f.torque[i];
      return Eigen::VectorXd(of->forces * (total + load_forces(s.loads(), at)));
    };
    forces(s.state());
    add_left_torque(total, blocks);
    Eigen::VectorXd q(of->mass.size()), resistance;
    test::Random random(2);
    for (Eigen::Index n = 0; n < q.size(); ++n) q[n] = random.uniform(-1, 1);
    const Eigen::VectorXd u = of->motions * q;
    blocks.multiply(u, resistance);
    constexpr double h = 1e-5;
    const auto at = [&](double by) { return forces(moved(s.state(), by * u)); };
    const Eigen::VectorXd change = -(8 * (at(h) - at(-h)) - (at(2 * h) - at(-2 * h))) / (12 * h);
    EXPECT_LT((of->forces * resistance - change).norm(), 1e-8 * change.norm()) << tension;
  }
}

// By Newton's method at once, along a schedule, and by damped dynamics.
TEST(Statics, SliceRestsWhereItsDynamicsEnds) {
  const RelaxGoal goal{1e-6, 1e-5};
  const auto twist = [](double last) {
    return fmt::format("twist_deg_per_nm = [[0, {}], [10, 1.5]]\ntension_nN = [[0, 10]]\n", last);
  };
  const auto ends = [](Simulation& s) { return s.read_gauges()[upper_end]; };
  Slice constant(slice_text("twist_deg_per_nm = [[0, 1.5]]\ntension_nN = [[0, 10]]\n", by_newton));
  constant.p.state = shaken(constant.p.state, 0.01);
  constant.p.loads.of<PeriodicLoad>().front()->place(constant.p.topology, constant.p.state);
  Simulation s = constant.make();
  const Statics end = NewtonStatics(s).relax(goal, 300, go_on);
  ASSERT_TRUE(end.relaxed.at_rest) << end.largest_force << " " << end.largest_torque;
  EXPECT_LT(end.newton_steps, 60);
  EXPECT_GT(std::fabs(ends(s).torque.z()), 1);

  Slice led(slice_text(twist(1.3), "[statics]\nsteps = 2\n" + by_newton));
  Simulation by_steps = led.make();
  NewtonStatics newton(by_steps);
  ASSERT_EQ(newton.follow(10, goal, go_on).end, Statics::End::at_rest);
  ASSERT_TRUE(newton.relax(goal, 300, go_on).relaxed.at_rest);

  Slice damped(slice_text(
      "twist_deg_per_nm = [[0, 1.5]]\ntension_nN = [[0, 10]]\n",
      "[damping]\ncontact_viscosity_eV_ps_per_nm2 = 20\nbond_damping_per_ps = 2\n[run]\nduration_ps = 1\n"));
  damped.p.state = constant.p.state;
  Simulation dynamics = damped.make();
  dynamics.steps(static_cast<long>(60 / damped.p.time_step));

  const double period = slice_length(s.topology(), s.state());
  for (Simulation* other : {&by_steps, &dynamics}) {
    const double tolerance = other == &by_steps ? 1e-5 : 2e-3;
    EXPECT_NEAR(other->forces().energy.bonds(), s.forces().energy.bonds(), tolerance * s.forces().energy.bonds());
    EXPECT_NEAR(slice_length(s.topology(), other->state()), period, 1e-2 * tolerance * period);
    EXPECT_NEAR(ends(*other).torque.z(), ends(s).torque.z(), tolerance * std::fabs(ends(s).torque.z()));
  }
}

// --- thick ropes -------------------------------------------------------------------------------------------------

// Couples spin its tubes a little, and the torque that this leaves on a tilted rope led it away from its state of
// rest in growing steps: from this start by 110 steps and more, from 1 degree per nm into a fold after 406, where
// the shift fell to a hundredth at once. The twist of the start is 85 degrees.
TEST(Statics, AThickRopeStopsAtItsStateOfRest) {
  MovingScene m(scene_of_text(
      "format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-tersoff\"\n[rope]\ntubes = 91\nlength_nm = 67.8\n"
      "[start]\ntwist_deg_per_nm = 1.3\n[twist]\nmoment_nN_nm = 15\nrate_nN_nm_per_ps = 1\n" +
          by_newton,
      "thick.toml"));
  const Statics end = NewtonStatics(m.simulation).relax(m.scene.run.goal, 40, go_on);
  ASSERT_TRUE(end.relaxed.at_rest) << end.largest_force;
  EXPECT_LE(end.newton_steps, 25);
  EXPECT_NEAR(m.row()["geometric_twist_deg"], 41.13, 0.02);
}

// --- ends without a state of rest ------------------------------------------------------------------------------

TEST(Statics, MotionsThatNothingHoldsAreNamed) {
  using ::testing::HasSubstr;
  const auto why = [](const Simulation& s) { return NewtonStatics::refusal(s).why; };
  Beam b(5);
  EXPECT_EQ(why(b.make()), "");
  b.loads.add(ForceLoad({4}, {0, 1, 0}));
  EXPECT_THAT(why(b.make()), HasSubstr("moves the whole scene along y"));
  b.loads.add(FixLoad({0}));
  EXPECT_EQ(why(b.make()), "");
  Beam spun(5);
  spun.loads.add(TorqueLoad({4}, {0, 0, 1}));
  EXPECT_THAT(why(spun.make()), HasSubstr("spins tube 0 about its axis"));
  Rope rope(5);
  rope.loads.add(TorqueLoad({4}, {0, 0, 1}));
  rope.loads.add(TorqueLoad({9}, {0, 0, -1}));
  EXPECT_THAT(why(rope.make()), HasSubstr("spins tube 0 about its axis"));
}

TEST(Statics, ALoadThatATubeDoesNotBearIsNamed) {
  Beam b(21);
  TwistLoad twist;
  twist.moment = 1.1 * b.bond().twist / element_length;
  add_twist(twist, b.topology, b.loads);
  Simulation s = b.make();
  const Statics end = NewtonStatics(s).relax({}, 300, go_on);
  EXPECT_FALSE(end.relaxed.at_rest);
  EXPECT_NE(overloaded_bond(s).find("slips at a twist of 90 degrees"), std::string::npos) << overloaded_bond(s);
}

// A couple below and above that of the edge of the window, where the torque of a tube ends to rise.
TEST(Statics, ATubeRestsBelowThePlateauOfItsCollapseAlone) {
  Beam b(15);
  b.topology.types[0].bond = test::anharmonic_bond();
  Anharmonic& h = b.topology.types[0].bond.anharmonic;
  h.coupling = h.e3 = h.e2s = h.es2 = h.s3 = h.e4 = h.e3s = h.e2s2 = h.es3 = 0;
  const double edge = twist_energy(h, b.bond().twist, h.max_shear / h.radius).by_twist;
  for (const double part : {0.99, 1.01}) {
    LoadsAndConstraints loads;
    TwistLoad twist;
    twist.moment = part * edge;
    add_twist(twist, b.topology, loads);
    Simulation s(b.topology, {}, loads, b.state, 0.01);
    NewtonOptions options;
    options.most_overloaded = 60;
    const Statics end = NewtonStatics(s, options).relax({}, 1000, go_on);
    EXPECT_EQ(end.relaxed.at_rest, part < 1);
    const EndWords words = end_words(s, end, false, false);
    if (part < 1) continue;
    EXPECT_THAT(words.why, ::testing::HasSubstr("has collapsed"));
    EXPECT_THAT(words.remedy, ::testing::HasSubstr("end the load below"));
  }
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
