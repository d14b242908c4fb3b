// Knobs of cost: the largest step, Runge-Kutta rotations, scaled masses.
#include <gtest/gtest.h>

#include "scene/loads/fix.hpp"
#include "scene/loads/force.hpp"
#include "sim/contact/line/law.hpp"
#include "sim/dynamics/simulation.hpp"
#include "sim/state/motion.hpp"
#include "unit/support.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

struct Bundle {
  Topology topology = test::published_topology();
  Interaction in;
  State state;
  double spacing = 0;

  // `part`: length of the elements, in those of the published model.
  explicit Bundle(double temperature, int elements = 5, double part = 1) {
    TubeType& type = topology.types[0];
    // Thin tubes shear: without it no mode of the chain is slower than the contact needs.
    type.bond.shear = thin_tube_shear(type.bond, type.radius);
    type.element_length *= part;
    type.mass *= part;
    type.inertia *= part;
    const double length = type.element_length;
    const LineDensity density = test::line_density();
    const LineWell well = line_parallel_well(density);
    const int nodes = line_nodes(length, well.distance, density.contact);
    in.law = line_law({LineContact{density, length, length, nodes, nodes}});
    spacing = well.distance;
    state = test::disordered_bundle(topology, 7, elements, spacing, 0, 1);
    test::set_velocities(topology, temperature, state);
  }
  void damp(double bonds = 1) {
    in.damping.contact = {20, spacing, 1.5 * spacing};
    in.damping.bond.rate = bonds;
  }
  TimeStepLimit limit() const { return time_step_limit(topology, in, spacing); }
  Simulation make(double step) const { return Simulation(topology, in, {}, state, step); }
};

State after(Simulation s, double ps) {
  const long steps = std::lround(ps / s.time_step());
  for (long k = 0; k < steps; ++k) s.step(false);
  return s.state();
}

double largest_distance(const State& a, const State& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, (a.position[i] - b.position[i]).norm());
  return largest;
}

// Long elements are stiffest where their contact tilts them: without that the limit of the longest was 1.8 times
// this.
TEST(StepLimit, HoldsForElementsOfAnyLength) {
  for (const double part : {0.5, 1.0, 2.0, 4.0}) {
    Bundle b(10, 12, part);
    b.damp();
    Simulation s = b.make(0.97 * b.limit().limit);
    const double before = kinetic_energy(s.topology(), s.state());
    for (int k = 0; k < 1000; ++k) ASSERT_NO_THROW(s.step(false)) << part << ", step " << k;
    EXPECT_LT(kinetic_energy(s.topology(), s.state()), 0.5 * before) << part;
  }
}

TEST(RungeKutta, RotationsConvergeWithTheFourthPower) {
  const Vector3 omega(0.3, -0.5, 0.4);
  const double ps = 8;
  const auto error = [&](int steps) {
    State s(1);
    s.angular_velocity.set(0, omega);
    s.orientation.set(0, test::turn(Vector3(1, 2, 3).normalized(), 0.7));
    const Quaternion exact = test::turn(omega.normalized(), omega.norm() * ps) * s.orientation[0];
    for (int k = 0; k < steps; ++k) move_elements_runge_kutta(s, ps / steps, 0, 1);
    EXPECT_NEAR(s.orientation[0].norm(), 1, 1e-14);
    return exact.angularDistance(s.orientation[0]);
  };
  const double coarse = error(8), fine = error(16);
  EXPECT_GT(coarse, 1e-6);
  EXPECT_NEAR(coarse / fine, 16, 1.5);
}

TEST(RungeKutta, BundlesMoveAsWithTheExactRotation) {
  const Bundle b(300);
  const State exact = after(b.make(0.01), 2);
  const State turned = after(Simulation(b.topology, b.in, {}, b.state, 0.01, 0, {true}), 2);
  EXPECT_LT(largest_distance(exact, turned), 1e-7);
  EXPECT_GT(largest_distance(exact, turned), 0);
}

// Four times the mass and twice the step: the same path, twice as slowly, bit by bit.
TEST(ScaledMass, StretchesTimeByItsRoot) {
  Bundle b(0), heavy(0);
  for (Bundle* x : {&b, &heavy})
    for (std::size_t i = 0; i < x->state.size(); ++i)
      x->state.position.x[i] += 0.01 * std::sin(static_cast<double>(7 * i));
  heavy.topology.types[0].mass *= 4;
  heavy.topology.types[0].inertia *= 4;
  EXPECT_NEAR(heavy.limit().limit / b.limit().limit, 2, 1e-12);
  const State light = after(b.make(0.01), 2), slow = after(heavy.make(0.02), 4);
  EXPECT_EQ(largest_distance(light, slow), 0);
  EXPECT_GT(largest_distance(light, b.state), 0.01);
}

// A cantilever comes to rest in one place whatever its mass. Its bond damping goes with the mass, so that motions
// die out as fast.
TEST(ScaledMass, LeavesTheEndStateAlone) {
  Topology topology = test::published_topology();
  topology.add_tube(6);
  State start(6);
  for (std::size_t e = 0; e < 6; ++e) start.position.z[e] = test::element_length * static_cast<double>(e);
  Interaction in;
  in.damping.bond.rate = 4;
  LoadsAndConstraints loads;
  loads.add(FixLoad({0}));
  loads.add(ForceLoad({5}, Vector3(5, 0, 0)));
  Topology heavy = topology;
  heavy.types[0].mass *= 9;
  heavy.types[0].inertia *= 9;
  const State light = after(Simulation(topology, in, loads, start, 0.01), 8000),
              slow = after(Simulation(heavy, in, loads, start, 0.03), 12000);
  EXPECT_GT(largest_distance(light, start), 0.1);
  EXPECT_LT(largest_distance(light, slow), 1e-6 * largest_distance(light, start));
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
