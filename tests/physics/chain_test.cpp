// A chain of elements is a beam: static loads, buckling loads, rings, waves, and where it stops being one.
#include <gtest/gtest.h>

#include <numeric>

#include "model/error.hpp"
#include "scene/loads/fix.hpp"
#include "scene/loads/force.hpp"
#include "scene/loads/rotate.hpp"
#include "scene/loads/torque.hpp"
#include "sim/dynamics/simulation.hpp"
#include "unit/support.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

using test::element_length;

constexpr double never = 0;

struct Chain {
  Topology topology = test::published_topology();
  Interaction in;
  LoadsAndConstraints loads;
  State state;
  int last = 0;

  explicit Chain(int elements) {
    topology.add_tube(elements);
    state = State(static_cast<std::size_t>(elements));
    for (int i = 0; i < elements; ++i) state.position.set(i, {0, 0, i * element_length});
    last = elements - 1;
  }
  double length() const { return last * element_length; }
  double step(double part = 0.6) const { return part * time_step_limit(topology, in, never).limit; }
  Simulation make(double part = 0.6) const { return Simulation(topology, in, loads, state, step(part)); }
  Simulation relaxed(double tolerance, long steps = 400000) const {
    Simulation s = make();
    EXPECT_TRUE(s.relax(tolerance, steps, [](long) { return true; })) << "largest force " << s.largest_force();
    return s;
  }
};

TEST(ChainStatics, Cantilever) {
  Chain c(31);
  const double force = 1e-2;  // eV/nm
  c.loads.add(FixLoad({0}));
  c.loads.add(ForceLoad({c.last}, {force, 0, 0}));
  const Simulation s = c.relaxed(1e-6);
  const double expected = force * std::pow(c.length(), 3) / (3 * c.topology.types[0].bond.bend);
  EXPECT_NEAR(s.state().position[c.last].x() / expected, 1, 1e-3);
}

// The bond with a shear stiffness is the exact element of a Timoshenko beam, whatever its length.
TEST(ChainStatics, CantileverThatShears) {
  Chain c(7);
  BondStiffness& k = c.topology.types[0].bond;
  k.shear = thin_tube_shear(k, c.topology.types[0].radius);
  const double force = 1e-2;  // eV/nm
  c.loads.add(FixLoad({0}));
  c.loads.add(ForceLoad({c.last}, {force, 0, 0}));
  const Simulation s = c.relaxed(1e-8);
  const double bending = force * std::pow(c.length(), 3) / (3 * k.bend), shear = force * c.length() / k.shear;
  EXPECT_GT(shear, 0.03 * bending);
  EXPECT_NEAR(s.state().position[c.last].x() / (bending + shear), 1, 1e-5);
}

TEST(ChainStatics, Stretch) {
  Chain c(11);
  c.loads.add(FixLoad({0}));
  c.loads.add(ForceLoad({c.last}, {0, 0, 5.0}));
  const Simulation s = c.relaxed(1e-8);
  const double strain = s.state().position[c.last].z() / c.length() - 1;
  EXPECT_NEAR(strain, 5.0 / c.topology.types[0].bond.stretch, 1e-9);
}

// Long before it has bent, no force on it is larger than a hundredth of the load's.
TEST(Relaxation, OfASlenderCantileverGoesOnToItsEnergy) {
  Chain c(61);
  c.loads.add(FixLoad({0}));
  c.loads.add(ForceLoad({60}, {0.06, 0, 0}));
  Simulation exact = c.make();
  ASSERT_TRUE(exact.relax(1e-8, 400000, [](long) { return true; }));
  const double bonds = exact.forces().energy.bonds();
  Simulation by_force = c.make(), s = c.make();
  ASSERT_TRUE(by_force.relax(0.02, 400000, [](long) { return true; }));
  EXPECT_LT(by_force.forces().energy.bonds(), 0.01 * bonds);
  for (const double tolerance : {1e-1, 1e-2, 1e-3}) {
    s = c.make();
    const double first = s.total_energy();
    const Relaxed end = s.relax(RelaxGoal{0.02, tolerance}, 400000, [](long) { return true; });
    EXPECT_TRUE(end.at_rest);
    EXPECT_LT(end.error, tolerance);
    EXPECT_NEAR(s.forces().energy.bonds() / bonds, 1, 1.5 * tolerance);
    EXPECT_NEAR(s.total_energy() - s.account().supplied(), first, 1e-9);
    EXPECT_NEAR(s.work() / (2 * bonds), 1, 2 * tolerance);  // of a constant force
  }
  EXPECT_FALSE(c.make().relax(RelaxGoal{0.02, 1e-3}, 500, [](long) { return true; }).at_rest);
}

// Again and again, and each time read from its bytes by another simulation.
TEST(Relaxation, InterruptedGoesOnToTheSameBits) {
  Chain c(31);
  c.loads.add(FixLoad({0}));
  c.loads.add(ForceLoad({30}, {0.06, 0, 0}));
  const RelaxGoal goal{0.02, 1e-2};
  Simulation whole = c.make();
  ASSERT_TRUE(whole.relax(goal, 400000, [](long) { return true; }).at_rest);
  Simulation s = c.make();
  int interruptions = 0;
  for (;; ++interruptions) {
    int steps = 0;
    if (s.relax(goal, 400000, [&](long) { return steps++ < 101; }).at_rest) break;
    ASSERT_LT(interruptions, 1000);
    ASSERT_EQ(s.relaxation_began(), 0);
    Simulation other = c.make();
    other.restore(s.serialise());
    s = std::move(other);
  }
  EXPECT_GT(interruptions, 5);
  EXPECT_TRUE(s.serialise() == whole.serialise());
}

// Straight to the last bit, so that no force acts sideways.
Chain column_under(double part_of_buckling_load) {
  Chain c(31);
  const double euler = units::pi * units::pi * c.topology.types[0].bond.bend / (c.length() * c.length());
  c.loads.add(FixLoad({0}, true, true, true, false));
  c.loads.add(FixLoad({c.last}, true, true, false, false));
  c.loads.add(ForceLoad({c.last}, {0, 0, -part_of_buckling_load * euler}));
  return c;
}

// With shear, a column buckles a little below its Euler load.
TEST(Relaxation, LeavesTheSaddleOfAStraightColumnAboveItsBucklingLoad) {
  for (const double part : {0.95, 1.05}) {
    Simulation s = column_under(part).make();
    const Relaxed end = s.relax(RelaxGoal{}, 400000, [](long) { return true; });
    ASSERT_TRUE(end.at_rest);
    EXPECT_TRUE(std::isfinite(end.above));
    const double bow = s.state().position[15].head<2>().norm();
    EXPECT_EQ(end.saddles, part > 1 ? 1 : 0) << bow;
    // P/Pc = 1 + slope^2/8 with the slope at the ends, and bow = slope L/pi.
    const double expected = part > 1 ? std::sqrt(8 * (part - 1)) * 30 * element_length / units::pi : 0;
    EXPECT_NEAR(bow, expected, 0.1 * expected + 1e-4);
  }
}

TEST(Relaxation, InterruptedOnASaddleGoesOnToTheSameBits) {
  const Chain c = column_under(1.2);
  Simulation whole = c.make();
  ASSERT_EQ(whole.relax(RelaxGoal{}, 400000, [](long) { return true; }).saddles, 1);
  Simulation s = c.make();
  for (int steps = 0; !s.relax(RelaxGoal{}, 400000, [&](long) { return steps++ % 307 != 306; }).at_rest;) {
    Simulation other = c.make();
    other.restore(s.serialise());
    s = std::move(other);
  }
  EXPECT_EQ(s.state().step, whole.state().step);
  EXPECT_TRUE(s.serialise() == whole.serialise());
}

TEST(Relaxation, InterruptedIsAtRestBeforeAStep) {
  Chain c(11);
  c.loads.add(FixLoad({0}));
  c.loads.add(ForceLoad({10}, {0.06, 0, 0}));
  Simulation s = c.make();
  s.relax(RelaxGoal{}, 400000, [](long k) { return k < 50; });
  EXPECT_GT(kinetic_energy(s.topology(), s.state()), 0);
  Simulation other = c.make();
  other.restore(s.serialise());
  other.end_relaxation();
  EXPECT_EQ(kinetic_energy(other.topology(), other.state()), 0);
  EXPECT_EQ(other.relaxation_began(), other.state().step);
  s.step();
  other.step();
  EXPECT_TRUE(s.serialise() == other.serialise());
}

// Deflection under a small lateral load grows as 1/(1 - P/P_cr): three loads below extrapolate to P_cr.
TEST(ChainBuckling, EulerColumn) {
  Chain c(31);
  const double euler = units::pi * units::pi * c.topology.types[0].bond.bend / (c.length() * c.length());
  std::vector<double> load, stiffness;
  for (double part : {0.5, 0.7, 0.85}) {
    Chain column = c;
    column.loads.add(FixLoad({0}, true, true, true, false));
    column.loads.add(FixLoad({c.last}, true, true, false, false));
    const double lateral = 1e-3;
    column.loads.add(ForceLoad({c.last}, {0, 0, -part * euler}));
    column.loads.add(ForceLoad({c.last / 2}, {lateral, 0, 0}));
    const Simulation s = column.relaxed(1e-7);
    load.push_back(part * euler);
    stiffness.push_back(lateral / s.state().position[c.last / 2].x());
  }
  const double slope = (stiffness[2] - stiffness[0]) / (load[2] - load[0]);
  const double critical = load[2] - stiffness[2] / slope;
  EXPECT_NEAR(critical / euler, 1, 0.02);
  EXPECT_NEAR((stiffness[1] - stiffness[0]) / (load[1] - load[0]) / slope, 1, 0.05);  // a line indeed
}

// Ends on the axis, one free along it; spins free, twisted by opposite couples of fixed direction. The
// stiffness against a small lateral force at the middle falls, close to the threshold, as 1 - (M/M_cr)^2.
enum class Ends { pinned, clamped };

double lateral_stiffness(double moment, Ends ends) {
  Chain c(31);
  const double lateral = 1e-3;
  c.loads.add(TorqueLoad({0}, {0, 0, -moment}));
  c.loads.add(TorqueLoad({c.last}, {0, 0, moment}));
  c.loads.add(ForceLoad({c.last / 2}, {lateral, 0, 0}));
  if (ends == Ends::pinned) {
    c.loads.add(FixLoad({0}, true, true, true, false));
    c.loads.add(FixLoad({c.last}, true, true, false, false));
  } else {
    c.loads.add(PrescribedRotation({0}, 0, 0, false, true));
    c.loads.add(PrescribedRotation({c.last}, 0, 0, true, true));
  }
  const double twist = std::asin(moment * element_length / c.topology.types[0].bond.twist);
  for (int i = 0; i <= c.last; ++i)
    c.state.orientation.set(i, test::turn(Vector3::UnitZ(), (i - 0.5 * c.last) * twist));
  const Simulation s = c.relaxed(1e-7);
  return lateral / s.state().position[c.last / 2].x();
}

double critical_moment(double expected, Ends ends) {
  const double m1 = 0.93 * expected, m2 = 0.96 * expected;
  const double k1 = lateral_stiffness(m1, ends), k2 = lateral_stiffness(m2, ends);
  const double slope = (k2 - k1) / (m2 * m2 - m1 * m1);
  return std::sqrt(m2 * m2 - k2 / slope);
}

TEST(ChainBuckling, GreenhillPinned) {
  const double expected = 2 * units::pi * test::published_bond().bend / (30 * element_length);
  EXPECT_NEAR(critical_moment(expected, Ends::pinned) / expected, 1, 0.02);
}

TEST(ChainBuckling, GreenhillClamped) {
  const double expected = 8.987 * test::published_bond().bend / (30 * element_length);
  EXPECT_NEAR(critical_moment(expected, Ends::clamped) / expected, 1, 0.02);
}

// N bonds around a full circle of circumference L; the closing element stands on the first.
double ring_energy_error(int bonds, double circumference) {
  const double radius = circumference / (2 * units::pi);
  const double a = 2 * radius * std::sin(units::pi / bonds);
  const BondStiffness k = test::published_bond();
  double energy = 0;
  for (int i = 0; i < bonds; ++i) {
    const double p = 2 * units::pi * i / bonds, q = 2 * units::pi * (i + 1) / bonds;
    const auto frame = [&](double angle) {
      return frame_of(test::turn(Vector3::UnitX(), -angle));  // t from z towards y
    };
    const auto at = [&](double angle) {
      return Vector3(0, radius * (1 - std::cos(angle)), radius * std::sin(angle));
    };
    energy += bond_energy(k, a, at(q) - at(p), frame(p), frame(q)).total();
  }
  const double turn = 2 * units::pi;
  const double continuum = 0.5 * k.bend * turn * turn / (bonds * a);
  return energy / continuum - 1;
}

TEST(ChainStatics, RingErrorFallsWithTheSquareOfTheElement) {
  const double coarse = ring_energy_error(50, 67.8), fine = ring_energy_error(100, 67.8);
  EXPECT_LT(std::fabs(coarse), 2e-3);
  EXPECT_NEAR(coarse / fine, 4, 0.05);
}

// First standing wave of a free chain: the projection on the mode passes zero after a quarter period.
double wave_speed(bool torsion) {
  Chain c(101);
  const auto mode = [&](int i) { return std::cos(units::pi * i / c.last); };
  for (int i = 0; i <= c.last; ++i) {
    if (torsion)
      c.state.angular_velocity.set(i, {0, 0, 1e-3 * mode(i)});
    else
      c.state.velocity.set(i, {0, 0, 1e-3 * mode(i)});
  }
  Simulation s = c.make(0.2);
  const auto projection = [&] {
    double sum = 0;
    for (int i = 0; i <= c.last; ++i)
      sum += mode(i) * (torsion ? s.state().angular_velocity[i].z() : s.state().velocity[i].z());
    return sum;
  };
  double before = projection();
  for (;;) {
    s.step();
    const double after = projection();
    if (after <= 0) {
      const double zero = s.state().time - s.time_step() * after / (after - before);
      // Free ends lie half an element beyond the last centres.
      return (c.length() + element_length) / (2 * zero);
    }
    before = after;
  }
}

TEST(ChainDynamics, AxialWaveSpeed) { EXPECT_NEAR(wave_speed(false), 21.3, 0.21); }  // nm/ps = km/s
TEST(ChainDynamics, TorsionalWaveSpeed) { EXPECT_NEAR(wave_speed(true), 14.6, 0.146); }

double energy_growth(double part) {
  Chain c(60);
  test::Random random(2);
  for (int i = 0; i <= c.last; ++i) {
    c.state.position.add(i, 1e-4 * random.direction());
    c.state.orientation.set(i, test::turn(random.direction(), 1e-4));
  }
  Simulation s = c.make(part);
  const double first = s.total_energy();
  for (int k = 0; k < 4000 && s.total_energy() < 1e3 * first; ++k) s.step();
  return s.total_energy() / first;
}

TEST(ChainDynamics, StabilityLimitIsWhereTheorySays) {
  EXPECT_LT(energy_growth(0.98), 30);  // bounded, though inflated close to the limit
  EXPECT_GT(energy_growth(1.02), 900);
}

TEST(ChainTwist, SlipIsRefused) {
  Chain c(11);
  const double peak = c.topology.types[0].bond.twist / element_length;
  c.loads.add(FixLoad({0}));
  c.loads.add(TorqueLoad({c.last}, {0, 0, 1.05 * peak}));
  c.in.damping.bond.rate = 2;
  Simulation s = c.make();
  try {
    for (int k = 0; k < 200000; ++k) s.step();
    FAIL() << "the bond slipped unseen";
  } catch (const NumericalError& e) {
    EXPECT_NE(std::string(e.what()).find("cannot carry more torque"), std::string::npos) << e.what();
    EXPECT_GE(e.element(), 0);
  }
}

TEST(ChainTwist, TurnsAreCountedBelowTheLimit) {
  Chain c(41);
  const double moment = 0.3 * c.topology.types[0].bond.twist / element_length;
  c.loads.add(FixLoad({0}));
  c.loads.add(TorqueLoad({c.last}, {0, 0, moment}));
  c.in.damping.bond.rate = 1;
  Simulation s = c.relaxed(1e-6);
  double total = 0;
  for (int i = 0; i < c.last; ++i)
    total += bond_twist_angle(frame_of(s.state().orientation[i]), frame_of(s.state().orientation[i + 1]));
  EXPECT_NEAR(total, 40 * std::asin(0.3), 1e-4);  // almost two turns, none forgotten
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
