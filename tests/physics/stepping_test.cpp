// Knobs of cost: two-level steps, Runge-Kutta rotations, scaled masses, shorter contact.
#include <gtest/gtest.h>

#include "model/error.hpp"
#include "scene/loads/fix.hpp"
#include "scene/loads/force.hpp"
#include "scene/loads/rotate.hpp"
#include "scene/loads/twist.hpp"
#include "sim/contact/line/law.hpp"
#include "sim/dynamics/simulation.hpp"
#include "sim/state/motion.hpp"
#include "unit/support.hpp"

namespace ropewalk {
namespace {

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
  Simulation make(double inner, int contact_every, const LoadsAndConstraints& loads = {}) const {
    return Simulation(topology, in, loads, state, inner * contact_every, 0, {contact_every, false});
  }
};

double fluctuation(Simulation& s, double ps) {
  double n = 0, sum = 0, squares = 0;
  const double first = s.total_energy();
  for (long k = 0; k < std::lround(ps / s.time_step()); ++k) {
    s.step();
    const double e = s.total_energy() - first;
    n += 1, sum += e, squares += e * e;
  }
  return std::sqrt(std::max(squares / n - sum * sum / n / n, 0.0));
}

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
    Simulation s = b.make(0.97 * b.limit().limit, 1);
    const double before = kinetic_energy(s.topology(), s.state());
    for (int k = 0; k < 1000; ++k) ASSERT_NO_THROW(s.step(false)) << part << ", step " << k;
    EXPECT_LT(kinetic_energy(s.topology(), s.state()), 0.5 * before) << part;
  }
}

TEST(TwoLevels, EnergyErrorFallsWithTheSquareOfTheStep) {
  const Bundle b(10);
  Simulation coarse = b.make(0.008, 4), fine = b.make(0.004, 4);
  EXPECT_NEAR(fluctuation(coarse, 100) / fluctuation(fine, 100), 4, 0.8);
}

TEST(TwoLevels, MotionConvergesToThatOfOneLevel) {
  const Bundle b(300);
  const State exact = after(b.make(0.0005, 1), 1.6);
  const double coarse = largest_distance(after(b.make(0.008, 4), 1.6), exact),
               fine = largest_distance(after(b.make(0.004, 4), 1.6), exact);
  EXPECT_NEAR(coarse / fine, 4, 0.4) << coarse << " nm";
  EXPECT_LT(fine, 1e-3 * largest_distance(b.state, exact));
}

TEST(TwoLevels, KeepMomentaAndEnergyOverOneNanosecond) {
  const Bundle b(10);
  const int every = 3;
  const double inner = default_step_fraction * inner_step_limit(b.limit(), every);
  Simulation s = b.make(inner, every);
  const double before = s.total_energy();
  const auto momentum = [&] {
    Vector3 linear = Vector3::Zero(), angular = Vector3::Zero();
    for (std::size_t i = 0; i < s.state().size(); ++i) {
      linear += s.state().velocity[i];
      angular += s.topology().types[0].mass * s.state().position[i].cross(s.state().velocity[i]) +
                 s.topology().types[0].inertia * s.state().angular_velocity[i];
    }
    return std::pair(linear, angular);
  };
  const auto was = momentum();
  const double scatter = fluctuation(s, 1000);
  EXPECT_LT(scatter, 1e-3 * std::fabs(before)) << before << " eV, " << s.time_step() << " ps";
  EXPECT_NEAR(s.total_energy(), before, 3e-3 * std::fabs(before));
  EXPECT_LT((momentum().first - was.first).norm(), 1e-9);
  EXPECT_LT((momentum().second - was.second).norm(), 1e-6 * was.second.norm());
}

// total energy - work + dissipated stays; what is left is of the first order, from damping forces of the half
// steps.
TEST(TwoLevels, AccountBalancesUnderLoadAndDamping) {
  Bundle b(0, 12);
  b.damp();
  std::vector<int> lower, upper;
  for (int t = 0; t < 7; ++t) {
    lower.push_back(b.topology.tube_begin[t]);
    upper.push_back(b.topology.tube_begin[t + 1] - 1);
  }
  TwistLoad twist;
  twist.moment = 100;
  twist.rate = 10;
  LoadsAndConstraints loads;
  loads.add(twist.on_grip(upper, 1));
  loads.add(twist.on_grip(lower, -1));
  const auto balance = [&](double inner) {
    Simulation s = b.make(inner, 4, loads);
    const double first = s.total_energy();
    for (long k = 0; k < std::lround(20 / s.time_step()); ++k) s.step();
    EXPECT_GT(s.work(), 50);
    EXPECT_GT(s.dissipated(), 1);
    return std::fabs(s.total_energy() - s.work() + s.dissipated() - first) / s.work();
  };
  const double coarse = balance(0.005), fine = balance(0.00125);
  EXPECT_LT(coarse, 5e-3);
  EXPECT_LT(fine, 0.4 * coarse);
}

TEST(TwoLevels, PrescribedRotationDoesTheWork) {
  const Bundle b(0, 12);
  LoadsAndConstraints loads;
  PrescribedRotation upper, lower;
  for (int t = 0; t < 7; ++t) {
    lower.elements.push_back(b.topology.tube_begin[t]);
    upper.elements.push_back(b.topology.tube_begin[t + 1] - 1);
  }
  upper.rate = 0.02, upper.angle = 0.4;
  loads.add(upper);
  loads.add(lower);
  Simulation s = b.make(0.005, 4, loads);
  const double first = s.total_energy();
  s.steps(1250);
  EXPECT_GT(s.work(), 1);
  EXPECT_LT(std::fabs(s.total_energy() - s.work() - first), 5e-3 * s.work());
}

TEST(TwoLevels, CheckpointGoesOnBitForBit) {
  Bundle b(3000, 40);
  b.damp();
  Simulation whole = b.make(0.005, 3);
  for (int k = 0; k < 301; ++k) whole.step();
  const std::string saved = whole.serialise();
  for (int k = 0; k < 300; ++k) whole.step();
  Simulation resumed = b.make(0.005, 3);
  resumed.restore(saved);
  EXPECT_EQ(resumed.serialise(), saved);
  for (int k = 0; k < 300; ++k) resumed.step();
  EXPECT_EQ(whole.serialise(), resumed.serialise());
  EXPECT_GT(whole.list().builds(), 1) << "the list was never rebuilt: the test shows nothing";
  Simulation other = b.make(0.005, 2);
  EXPECT_THROW(other.restore(saved), std::runtime_error);
}

// Forces of the two levels add up to those of one.
TEST(TwoLevels, PartsAreTheWhole) {
  Bundle b(300, 8);
  b.damp();
  const Simulation one = b.make(0.01, 1), two = b.make(0.005, 2);
  for (std::size_t i = 0; i < b.state.size(); ++i) {
    EXPECT_LT((one.forces().force[i] - two.forces().force[i]).norm(), 1e-9);
    EXPECT_LT((one.forces().torque[i] - two.forces().torque[i]).norm(), 1e-9);
  }
  EXPECT_NEAR(one.forces().energy.potential(), two.forces().energy.potential(), 1e-9);
  EXPECT_NEAR(one.forces().damping_power, two.forces().damping_power, 1e-9);
}

// A mode w of bonds under an impulse W once in a period, written out by hand: its map stops being stable where the
// limit says.
TEST(TwoLevels, LimitIsThatOfAnOscillatorUnderImpulses) {
  for (const double contact : {2.0, 5.0, 10.0})
    for (const double chain : {8.0, 15.0, 40.0}) {
      TimeStepLimit l;
      l.chain_frequency = l.sideways_frequency = chain;
      l.contact_frequency = contact;
      const int every = 100;  // the inner steps are not what limits
      const double outer = inner_step_limit(l, every) * every;
      const auto trace = [&](double dt) {
        return 2 * std::cos(chain * dt) - contact * contact * dt / chain * std::sin(chain * dt);
      };
      for (double part = 0.01; part < 1; part += 0.01) EXPECT_GT(trace(part * outer), -2);
      EXPECT_LT(trace(1.0005 * outer), -2) << contact << " " << chain;
    }
}

// Growth of the kinetic energy of small motions about rest.
double growth(const Bundle& rest, double inner, int every, double ps) {
  Bundle shaken = rest;
  test::set_velocities(shaken.topology, 1e-3, shaken.state);
  const double before = kinetic_energy(shaken.topology, shaken.state);
  double factor = 0;
  try {
    Simulation s = shaken.make(inner, every);
    for (long k = 0; k < std::lround(ps / s.time_step()) && factor < 1e6; ++k) {
      s.step(false);
      factor = std::max(factor, kinetic_energy(shaken.topology, s.state()) / before);
    }
  } catch (const NumericalError&) {
    return 1e6;
  }
  return factor;
}

// Short elements, whose bonds are three times as stiff as their contact.
TEST(TwoLevels, ABundleIsStableBelowTheLimitAndNotFarBeyond) {
  Bundle rest(0, 10, 0.5);
  Simulation s = rest.make(0.005, 1);
  ASSERT_TRUE(s.relax(1e-6, 100000, [](long) { return true; }));
  rest.state = s.state();
  // Tubes that are not quite at rest slide into their places.
  const double control = growth(rest, 0.6 * rest.limit().limit, 1, 60);
  for (const int every : {2, 3, 5})
    EXPECT_LT(growth(rest, 0.95 * inner_step_limit(rest.limit(), every), every, 60), 1.2 * control) << every;
  // The estimate is of an endless rope under pressure: seven tubes bear twice the step.
  EXPECT_GT(growth(rest, 2.5 * inner_step_limit(rest.limit(), 5), 5, 60), 100 * control);
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
  const State exact = after(b.make(0.01, 1), 2);
  const State turned = after(Simulation(b.topology, b.in, {}, b.state, 0.01, 0, {1, true}), 2);
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
  const State light = after(b.make(0.01, 1), 2), slow = after(heavy.make(0.02, 1), 4);
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

}  // namespace
}  // namespace ropewalk
