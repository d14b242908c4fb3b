// Clamps of a testing machine: schedules, rigid discs, free components, and readings of the gauges at both ends.
#include "scene/ends/grip.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "scene/ends/twist.hpp"
#include "sim/contact/paper/law.hpp"
#include "sim/dynamics/simulation.hpp"
#include "unit/support.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

using Is = GripAxis::Is;

constexpr double spacing = 1.713;

GripAxis moved(std::vector<Schedule::Point> points) { return {Is::moved, std::move(points), false}; }
GripAxis loaded(double value) { return {Is::loaded, {{0, value}}, false}; }
GripAxis free_axis() { return {Is::free, {}, false}; }

// Seven tubes at rest, in double precision.
struct Rope {
  Topology topology = test::published_topology();
  Interaction in;
  State state;

  explicit Rope(int elements = 12, double displaced = 0) {
    state = test::disordered_bundle(topology, 7, elements, spacing, displaced, 1);
    state.velocity = state.angular_velocity = Vec3Array(state.size());
    in.law = paper_law(test::published_contact());
    in.damping.contact = {20, spacing, 1.5 * spacing};
    in.damping.bond.rate = 0.2;
  }
  GripLoad at(GripLoad grip, End end) const {
    grip.end = end;
    return grip.on_elements(tube_ends(topology)[end], topology);
  }
  Simulation make(const GripLoad& lower, const GripLoad& upper, double dt = 0.01) const {
    LoadsAndConstraints loads;
    loads.add(at(lower, lower_end));
    loads.add(at(upper, upper_end));
    return Simulation(topology, in, loads, state, dt);
  }
};

double twisting(const EndReading& r) { return r.torque.z(); }

TEST(Schedule, MeetsItsPointsWithoutAJumpOfSpeed) {
  const Schedule s({{10, 0}, {30, 2}, {40, 4}, {60, 4}, {100, -2}}, 6);
  for (const Schedule::Point& p : s.points()) EXPECT_NEAR(s.value(p.time), p.value, 1e-13) << p.time;
  double sum = 0, before = s.rate(0);
  constexpr double dt = 1e-3;
  for (int k = 0; k < 120000; ++k) {
    const double t = (k + 0.5) * dt, rate = s.rate(t);
    sum += dt * rate;
    EXPECT_LT(std::fabs(rate - before), 2e-4) << t;  // of 0.25 at most
    EXPECT_NEAR(sum, s.value(t + 0.5 * dt), 1e-6) << t;
    before = rate;
  }
  for (const double still : {0.0, 10.0, 60.0, 50.0, 100.0, 110.0}) EXPECT_EQ(s.rate(still), 0) << still;
  EXPECT_NEAR(s.rate(30), 0.1, 1e-15);  // of the slower line
}

TEST(Schedule, WithoutSmoothingIsTheLinesThemselves) {
  const Schedule s({{0, 0}, {10, 1}, {20, 0}});
  EXPECT_EQ(s.rate(5), 0.1);
  EXPECT_EQ(s.rate(15), -0.1);
  EXPECT_NEAR(s.value(12.5), 0.75, 1e-15);
  EXPECT_EQ(s.ends(), 20);
  EXPECT_EQ(Schedule({{0, 3}}).value(-1), 3);
  EXPECT_EQ(Schedule().value(7), 0);
}

// A disc that nothing holds tumbles as a rigid body, with the momentum that its elements had.
TEST(Grip, FreeDiscKeepsMomentumEnergyAndShape) {
  Topology topology = test::published_topology();
  State state = test::disordered_bundle(topology, 7, 1, spacing, 0.1, 1);
  test::set_velocities(topology, 300, state);
  GripLoad grip;
  grip.axes.fill(free_axis());
  std::vector<int> all(7);
  std::iota(all.begin(), all.end(), 0);
  LoadsAndConstraints loads;
  loads.add(grip.on_elements(all, topology));
  const auto momentum = [&](const State& s) {
    Vector3 p = Vector3::Zero(), l = Vector3::Zero();
    for (std::size_t i = 0; i < s.size(); ++i) {
      p += topology.types[0].mass * s.velocity[i];
      l += topology.types[0].mass * s.position[i].cross(s.velocity[i]) +
           topology.types[0].inertia * s.angular_velocity[i];
    }
    return std::make_pair(p, l);
  };
  const auto [p, l] = momentum(state);
  Simulation s(topology, Interaction(), loads, state, 0.01);
  const double energy = s.total_energy();
  s.steps(20000);
  const auto [p1, l1] = momentum(s.state());
  EXPECT_LT((p1 - p).norm(), 1e-11 * p.norm());
  EXPECT_LT((l1 - l).norm(), 1e-4 * l.norm());
  EXPECT_NEAR(s.total_energy(), energy, 1e-4 * energy);
  for (std::size_t i = 1; i < 7; ++i) {
    const double was = (state.position[i] - state.position[0]).norm();
    EXPECT_NEAR((s.state().position[i] - s.state().position[0]).norm(), was, 1e-6) << i;
  }
  EXPECT_GT((axis_of(s.state().orientation[0]) - axis_of(state.orientation[0])).norm(), 0.1) << "it did not tumble";
}

TEST(Grip, DiscTurnsOnItsCircleAndTheGaugeCountsWholeTurns) {
  const Rope rope;
  GripLoad upper;
  upper.axes[GripLoad::about_z] = moved({{0, 0}, {200, 4 * units::pi}});
  upper.smooth = 20;
  GripLoad lower = upper;
  Simulation s = rope.make(lower, upper);
  s.steps(20500);
  const EndReadings read = s.read_gauges();
  for (const EndReading& r : read) EXPECT_NEAR(r.turned, 4 * units::pi, 1e-9);
  const EndElements ends = tube_ends(rope.topology);
  for (const auto& elements : ends)
    for (const int e : elements) {
      const auto i = static_cast<std::size_t>(e);
      EXPECT_NEAR(s.state().position[i].head<2>().norm(), rope.state.position[i].head<2>().norm(), 1e-8);
      EXPECT_NEAR(s.state().position.z[i], rope.state.position.z[i], 1e-12);
    }
  EXPECT_LT((s.state().position[0] - rope.state.position[0]).norm(), 1e-6);  // two whole turns
}

// The work that loads put in is the work that the gauges read; the sums close the account.
TEST(Gauges, WorkOfTheReactionsIsThatOfTheAccountOverALoop) {
  const Rope rope(20);
  GripLoad upper;
  upper.axes[GripLoad::about_z] = moved({{0, 0}, {60, 0.5}, {80, 0.5}, {140, 0}});
  upper.axes[GripLoad::z] = moved({{0, 0}, {60, 0.2}, {140, 0}});
  upper.smooth = 10;
  Simulation s = rope.make(GripLoad(), upper, 0.005);
  s.read_gauges();
  double work = 0, turned = 0, most = 0;
  double z = s.state().position.z[static_cast<std::size_t>(rope.topology.tube_begin[1] - 1)];
  for (int k = 0; k < 2800; ++k) {
    s.steps(10);
    const EndReadings r = s.read_gauges();
    const double here = s.state().position.z[static_cast<std::size_t>(rope.topology.tube_begin[1] - 1)];
    work += twisting(r[upper_end]) * (r[upper_end].turned - turned) + r[upper_end].force.z() * (here - z);
    turned = r[upper_end].turned;
    z = here;
    most = std::max(most, std::fabs(s.work()));
    EXPECT_NEAR(r[upper_end].work + r[lower_end].work, s.work(), 1e-9 * (1 + most));
  }
  EXPECT_GT(most, 5);
  EXPECT_NEAR(work, s.work(), 1e-4 * most);
  EXPECT_NEAR(turned, 0, 1e-9);
}

TEST(Gauges, ActionAndReactionAreEqualAtRest) {
  Rope rope(12);
  GripLoad upper;
  upper.axes[GripLoad::about_z] = moved({{0, 0}, {40, 0.3}});
  upper.axes[GripLoad::z] = moved({{0, 0}, {40, 0.1}});
  upper.axes[3] = moved({{0, 0}, {40, 0.05}});
  Simulation turned = rope.make(GripLoad(), upper);
  turned.steps(6000);
  rope.state = turned.state();
  Simulation s = rope.make(GripLoad(), GripLoad());
  ASSERT_TRUE(s.relax(1e-9, 200000, [](long) { return true; }));
  const EndReadings r = s.read_gauges();
  const Vector3 force = r[upper_end].force, torque = r[upper_end].torque;
  EXPECT_GT(torque.z(), 1);
  EXPECT_GT(force.z(), 10);
  EXPECT_LT((force + r[lower_end].force).norm(), 1e-6 * force.norm());
  const Vector3 apart = centre_of(rope.topology, s.state(), s.gauges().ends()[upper_end]) -
                        centre_of(rope.topology, s.state(), s.gauges().ends()[lower_end]);
  EXPECT_LT((torque + r[lower_end].torque + apart.cross(force)).norm(), 1e-6 * apart.cross(force).norm());
  EXPECT_LT(std::fabs(torque.z() + r[lower_end].torque.z()), 1e-6 * torque.z());
}

// A load on a free component is what the gauge reads, and its work is the load times the way.
TEST(Grip, LoadsAreWhatTheGaugesRead) {
  const Rope rope;
  GripLoad upper;
  upper.axes[GripLoad::about_z] = loaded(60);
  upper.axes[GripLoad::z] = loaded(5);
  Simulation s = rope.make(GripLoad(), upper);
  s.steps(500);
  s.read_gauges();
  s.steps(500);
  const EndReading r = s.read_gauges()[upper_end];
  EXPECT_NEAR(r.torque.z(), 60, 6e-5);  // the chord of a turn is not the arc
  EXPECT_NEAR(r.force.z(), 5, 1e-9);
  const auto e = static_cast<std::size_t>(rope.topology.tube_begin[1] - 1);
  EXPECT_NEAR(r.work, 60 * r.turned + 5 * (s.state().position.z[e] - rope.state.position.z[e]), 1e-3 * r.work);
  EXPECT_GT(r.turned, 0.01);
}

// A disc under a couple turns by half a radian or so on the way to its rest.
TEST(Grip, KeepsItsShapeInARelaxationAndTheGaugesReadTurnAndWork) {
  const Rope rope;
  GripLoad upper;
  upper.axes[GripLoad::about_z] = loaded(600);
  upper.axes[GripLoad::z] = loaded(5);
  Simulation s = rope.make(GripLoad(), upper);
  ASSERT_TRUE(s.relax(RelaxGoal{}, 100000, [](long) { return true; }).at_rest);
  const EndElements ends = tube_ends(rope.topology);
  const auto arm = [&](const State& state, int k) -> Vector3 {
    return state.position[static_cast<std::size_t>(ends[upper_end][static_cast<std::size_t>(k)])] -
           state.position[static_cast<std::size_t>(ends[upper_end][0])];
  };
  for (int k = 1; k < 7; ++k) EXPECT_NEAR(arm(s.state(), k).norm(), arm(rope.state, k).norm(), 1e-4) << k;
  const Vector3 a = arm(rope.state, 1), b = arm(s.state(), 1);
  const double turned = std::atan2(a.cross(b).z(), a.dot(b));
  EXPECT_GT(turned, 0.5);
  const EndReadings read = s.read_gauges();
  EXPECT_NEAR(read[upper_end].turned, turned, 1e-9);
  EXPECT_EQ(read[lower_end].turned, 0);
  const double work = 600 * turned + 5 * (centre_of(rope.topology, s.state(), ends[upper_end]).z() -
                                          centre_of(rope.topology, rope.state, ends[upper_end]).z());
  EXPECT_NEAR(read[upper_end].work, work, 1e-3 * work);
  EXPECT_NEAR(read[upper_end].work, s.work(), 1e-9 * work);
  EXPECT_EQ(read[lower_end].work, 0);
}

// A clamp for each tube with a couple on it is [twist] per tube.
TEST(Grip, EachUnderACoupleIsTheTwistProtocol) {
  const Rope rope(12, 0.01);
  TwistLoad protocol;
  protocol.moment = 15;
  LoadsAndConstraints loads;
  add_twist(protocol, rope.topology, loads);
  Simulation twisted(rope.topology, rope.in, loads, rope.state, 0.01);
  GripLoad upper;
  upper.axes.fill(free_axis());
  upper.each = true;
  upper.axes[GripLoad::about_z] = loaded(15);
  GripLoad lower = upper;
  lower.axes[GripLoad::about_z] = loaded(-15);
  Simulation gripped = rope.make(lower, upper);
  twisted.steps(1000);
  gripped.steps(1000);
  double largest = 0;
  for (std::size_t i = 0; i < rope.state.size(); ++i)
    largest = std::max(largest, (twisted.state().position[i] - gripped.state().position[i]).norm());
  EXPECT_LT(largest, 1e-9);
  EXPECT_NEAR(twisted.work(), gripped.work(), 1e-9 * twisted.work());
  EXPECT_GT(twisted.work(), 1);
}

// Released components move as they would without the clamp, and held ones do not.
TEST(Grip, LetsGoWhatItIsToLetGo) {
  Topology topology = test::published_topology();
  State state = test::disordered_bundle(topology, 7, 1, spacing, 0.1, 1);
  test::set_velocities(topology, 300, state);
  std::vector<int> all(7);
  std::iota(all.begin(), all.end(), 0);
  const auto after = [&](bool slide, bool spin, bool tilt) {
    GripLoad grip;
    grip.slide_free = slide, grip.spin_free = spin, grip.tilt_free = tilt;
    State s = state;
    grip.on_elements(all, topology).constrain(topology, 0, 0, s);
    return s;
  };
  const State slides = after(true, false, false), spins = after(false, true, false),
              tilts = after(false, false, true);
  Vector3 axis = Vector3::Zero();
  for (const int e : all) axis += axis_of(state.orientation[static_cast<std::size_t>(e)]);
  axis.normalize();
  for (std::size_t i = 0; i < 7; ++i) {
    const Vector3 t = axis_of(state.orientation[i]), w = state.angular_velocity[i], v = state.velocity[i];
    EXPECT_LT((slides.velocity[i] - v.dot(axis) * axis).norm(), 1e-14);
    EXPECT_LT(slides.angular_velocity[i].norm(), 1e-14);
    EXPECT_LT((spins.angular_velocity[i] - w.dot(t) * t).norm(), 1e-14);
    EXPECT_LT((tilts.angular_velocity[i] - (w - w.dot(t) * t)).norm(), 1e-14);
    EXPECT_LT(spins.velocity[i].norm() + tilts.velocity[i].norm(), 1e-14);
  }
}

TEST(Grip, SeesALoadThatNothingFeels) {
  Topology topology = test::published_topology();
  const State state = test::disordered_bundle(topology, 1, 3, spacing, 0, 1);
  GripLoad grip;
  grip.axes[GripLoad::about_z] = loaded(1);
  EXPECT_FALSE(grip.on_elements({2}, topology).is_unfelt(GripLoad::about_z, state));
  grip.spin_free = true;  // of a single tube on the axis
  EXPECT_TRUE(grip.on_elements({2}, topology).is_unfelt(GripLoad::about_z, state));
}

TEST(Gauges, GoOnWithTheSameBitsAfterACheckpoint) {
  const Rope rope;
  GripLoad upper;
  upper.axes[GripLoad::about_z] = moved({{0, 0}, {10, 0.3}, {20, 0}});
  Simulation whole = rope.make(GripLoad(), upper);
  whole.steps(700);
  whole.read_gauges();
  whole.steps(50);
  const std::string saved = whole.serialise();
  whole.steps(500);
  Simulation resumed = rope.make(GripLoad(), upper);
  resumed.restore(saved);
  resumed.steps(500);
  const EndReadings a = whole.read_gauges(), b = resumed.read_gauges();
  for (const End end : {lower_end, upper_end}) {
    EXPECT_EQ(a[end].torque, b[end].torque);
    EXPECT_EQ(a[end].turned, b[end].turned);
    EXPECT_EQ(a[end].work, b[end].work);
  }
  EXPECT_EQ(whole.serialise(), resumed.serialise());
  EXPECT_NE(a[upper_end].work, 0);
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
