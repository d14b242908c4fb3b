// The Langevin thermostat: the canonical distribution in every kind of motion, and the rules that thermostats keep.
#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "model/counter_random.hpp"
#include "observe/time_mean.hpp"
#include "scene/ends/twist.hpp"
#include "scene/loads/fix.hpp"
#include "scene/loads/force.hpp"
#include "scene/loads/rotate.hpp"
#include "scene/loads/torque.hpp"
#include "sim/contact/line/law.hpp"
#include "sim/dynamics/langevin.hpp"
#include "sim/dynamics/simulation.hpp"
#include "sim/dynamics/verlet.hpp"
#include "unit/support.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

using test::element_length;
constexpr double room = 300;  // K
constexpr double kT = units::boltzmann * room;

Stepping langevin(double temperature, double friction, std::uint64_t seed = 1) {
  Stepping stepping;
  stepping.thermostat = std::make_shared<LangevinThermostat>(Schedule::always(temperature), friction, seed);
  return stepping;
}

// A straight tube along z without contact.
struct Chain {
  Topology topology = test::published_topology();
  Interaction in;
  LoadsAndConstraints loads;
  State state;

  explicit Chain(int elements) {
    BondStiffness& bond = topology.types[0].bond;
    bond.shear = thin_tube_shear(bond, topology.types[0].radius);
    topology.add_tube(elements);
    state = State(static_cast<std::size_t>(elements));
    for (std::size_t i = 0; i < state.size(); ++i) state.position.z[i] = element_length * static_cast<double>(i);
  }
  double limit() const { return time_step_limit(topology, in, 0).limit; }
  Simulation make(double step, const Stepping& stepping) const {
    return Simulation(topology, in, loads, state, step, 0, stepping);
  }
};

double translational(const Simulation& s) {
  double sum = 0;
  for (std::size_t i = 0; i < s.state().size(); ++i) sum += s.state().velocity[i].squaredNorm();
  return 0.5 * s.topology().types[0].mass * sum;
}

// The counts are those of the energies' quadratic terms: stretch and twist have one in each bond, shear and bend
// two. 1.4e6 steps, hence about 1e5 independent values of each term: a standard error of 0.5 %.
TEST(Langevin, EveryKindOfMotionHoldsHalfAkT) {
  const Chain chain(12);
  Simulation s = chain.make(0.1 * chain.limit(), langevin(room, 8));
  const double bonds = chain.topology.bonds(), elements = chain.topology.elements();
  double samples = 0, stretch = 0, shear = 0, bend = 0, twist = 0, moves = 0, turns = 0;
  s.steps(20000);
  for (; samples < 140000; samples += 1) {
    s.steps(10);
    const Energies& e = s.forces().energy;
    stretch += e.stretch;
    shear += e.shear;
    bend += e.bend;
    twist += e.twist;
    const double translation = translational(s);
    moves += translation;
    turns += kinetic_energy(s.topology(), s.state()) - translation;
  }
  const auto per_term = [&](double sum, double terms) { return sum / samples / terms / (0.5 * kT); };
  EXPECT_NEAR(per_term(stretch, bonds), 1, 0.02);
  EXPECT_NEAR(per_term(shear, 2 * bonds), 1, 0.02);
  EXPECT_NEAR(per_term(bend, 2 * bonds), 1, 0.02);
  EXPECT_NEAR(per_term(twist, bonds), 1, 0.02);
  EXPECT_NEAR(per_term(moves, 3 * elements), 1, 0.02);
  EXPECT_NEAR(per_term(turns, 3 * elements), 1, 0.02);
}

// What the kinetic energy at the end of a step lacks: the mean of those before and after the whole kick of a step, each
// of which has the temperature of the bath, is larger by the square of half a kick.
double missing_kinetic(const Simulation& s, double step) {
  const TubeType& type = s.topology().types[0];
  double sum = 0;
  for (std::size_t i = 0; i < s.state().size(); ++i)
    sum += s.forces().force[i].squaredNorm() / type.mass + s.forces().torque[i].squaredNorm() / type.inertia;
  return step * step / 8 * sum;
}

// Runs of a chain that differ by their seed, each with the error of its own mean: the part of them that has the true
// mean within one error, the mean of all runs over the true one, and the mean correlation time in rows.
struct Coverage {
  double within = 0, mean = 0, rows = 0;
};
template <class Value>
Coverage coverage(int runs, const Chain& chain, double step, double truth, const Value& value) {
  constexpr std::size_t values = 2000;
  Coverage all;
  for (int run = 1; run <= runs; ++run) {
    Simulation s = chain.make(step, langevin(room, 8, static_cast<std::uint64_t>(run)));
    s.steps(3000);
    std::vector<double> seen;
    while (seen.size() < values) {
      s.steps(10);
      seen.push_back(value(s));
    }
    const TimeMean mean = time_mean(seen);
    if (std::fabs(mean.mean - truth) < mean.error) all.within += 1.0 / runs;
    all.mean += mean.mean / truth / runs;
    all.rows += mean.rows / runs;
  }
  return all;
}

// The true mean, by equipartition, lies within one error in 68.3 % of the runs, within two binomial standard errors. (The
// first 300 of the 1200 runs have 62.7 %, all have 67.2 %.) The kinetic energy is measured with long steps, and what the
// end of a step lacks is added to it.
TEST(LangevinLong, ErrorsOfMeansCoverTheTrueMean) {
  const Chain chain(5);
  const Coverage bend = coverage(1200, chain, 0.1 * chain.limit(), 2 * chain.topology.bonds() * 0.5 * kT,
                                 [](const Simulation& s) { return s.forces().energy.bend; });
  EXPECT_NEAR(bend.within, 0.683, 0.027);
  EXPECT_NEAR(bend.mean, 1, 3e-3);
  EXPECT_GT(bend.rows, 1) << "neighbouring values are alike";
  const double step = 0.3 * chain.limit(), of_motion = 6 * chain.topology.elements() * 0.5 * kT;
  double at_the_end = 0;
  const Coverage motion = coverage(300, chain, step, of_motion, [&](const Simulation& s) {
    const double now = kinetic_energy(s.topology(), s.state());
    at_the_end += now / 600000;
    return now + missing_kinetic(s, step);
  });
  EXPECT_NEAR(motion.within, 0.683, 0.054);
  EXPECT_NEAR(motion.mean, 1, 2e-3);
  EXPECT_LT(at_the_end / of_motion, 0.996);
}

// From 100 to 400 K and back, slowly against the coupling. 6 x 400 kinetic terms: 3 % in a single reading, 1 % in
// the mean over some 20 independent ones.
TEST(Langevin, BathFollowsItsSchedule) {
  const Chain chain(400);
  Stepping stepping;
  stepping.thermostat =
      std::make_shared<LangevinThermostat>(Schedule({{0, 100}, {20, 100}, {40, 400}, {60, 400}, {80, 100}}), 2, 1);
  Simulation s = chain.make(0.3 * chain.limit(), stepping);
  const auto temperature = [&](double from, double to) {
    double sum = 0;
    int count = 0;
    while (s.state().time < to) {
      s.steps(20);
      if (s.state().time < from) continue;
      sum += kinetic_energy(s.topology(), s.state()) / (3.0 * 400 * units::boltzmann);
      ++count;
    }
    return sum / count;
  };
  EXPECT_NEAR(temperature(8, 20), 100, 4);
  EXPECT_NEAR(temperature(29, 31), 250, 15);
  EXPECT_NEAR(temperature(48, 60), 400, 16);
  EXPECT_NEAR(temperature(88, 100), 100, 4);
}

// <t(0).t(s)> = exp(-s/P) with P = EI/kT. That of the tube is 87 micrometres, 64000 elements: none of this length
// would bend measurably. This chain has the tube's form with an EI for P = 40 elements, and is as soft otherwise as
// leaves its bonds nearly straight. The discrete chain's P is 1.3 % shorter than the continuous one's.
TEST(Langevin, ChainsHaveTheirPersistenceLength) {
  Chain chain(21);
  const double persistence = 40 * element_length;
  BondStiffness& bond = chain.topology.types[0].bond;
  bond = {2000 * kT / element_length, persistence * kT, 0.9 * persistence * kT, 0};
  Simulation s = chain.make(0.5 * chain.limit(), langevin(room, 0.5));
  constexpr std::size_t apart = 10;
  std::array<double, apart + 1> correlation{};
  double samples = 0;
  s.steps(20000, false);
  for (int k = 0; k < 60000; ++k) {
    s.steps(15, false);
    for (std::size_t i = 0; i + apart < s.state().size(); ++i) {
      const Vector3 t = axis_of(s.state().orientation[i]);
      for (std::size_t n = 1; n <= apart; ++n) correlation[n] += t.dot(axis_of(s.state().orientation[i + n]));
      samples += 1;
    }
  }
  double sum = 0, squares = 0;  // least squares of ln <t.t> = -s/P
  for (std::size_t n = 1; n <= apart; ++n) {
    const double distance = element_length * static_cast<double>(n);
    sum -= distance * std::log(correlation[n] / samples);
    squares += distance * distance;
  }
  EXPECT_NEAR(squares / sum / persistence, 1, 0.05);
}

// Free elements without any force between them: a straight tube that flies and spins as a whole.
TEST(Langevin, IsPureFrictionAtZeroTemperature) {
  Chain chain(5);
  for (std::size_t i = 0; i < chain.state.size(); ++i) {
    chain.state.velocity.set(i, {0.1, 0.2, -0.3});
    chain.state.angular_velocity.set(i, {0, 0, 0.4});
  }
  const double friction = 0.7;
  Simulation s = chain.make(0.3 * chain.limit(), langevin(0, friction));
  const double moved = translational(s), all = kinetic_energy(s.topology(), s.state());
  ASSERT_GT(all, 1.2 * moved);
  for (int k = 0; k < 5; ++k) {
    s.steps(100);
    const double left = std::exp(-2 * friction * s.state().time);
    EXPECT_NEAR(translational(s) / (moved * left), 1, 1e-11);
    EXPECT_NEAR(kinetic_energy(s.topology(), s.state()) / (all * left), 1, 1e-11);
    EXPECT_NEAR(s.heat() / (all * (left - 1)), 1, 1e-11);
  }
}

// A bundle in contact whose every kind of load and constraint acts, in several blocks and with two tube types.
struct LoadedBundle {
  Topology topology = test::published_topology();
  Interaction in;
  LoadsAndConstraints loads;
  State state;

  LoadedBundle() {
    const double spacing = line_parallel_well(test::line_density()).distance;
    in.law = line_law(std::vector<LineContact>(4, test::line_contact(0.6785, 6, 0.6785, 6)));
    in.precision = Interaction::Precision::mixed;
    topology.types.push_back(topology.types[0]);
    topology.types[1].mass *= 1.5;
    topology.types[1].inertia *= 1.7;
    state = test::disordered_bundle(topology, 7, 83, spacing, 0, 1);
    for (int t = 0; t < 6; t += 3) topology.tube_type[static_cast<std::size_t>(t)] = 1;
    test::set_velocities(topology, room, state);
    const auto end_of = [&](int tube) { return topology.tube_begin[tube + 1] - 1; };
    loads.add(ForceLoad({3}, {0.1, 0, -0.2}));
    loads.add(TorqueLoad({3}, {0, 0.3, 0}));
    loads.add(FixLoad({0}));
    loads.add(FixLoad({topology.tube_begin[1]}, true, false, true, false));
    PrescribedRotation rotation;
    rotation.elements = {end_of(4), end_of(3)};
    rotation.rate = 0.05, rotation.angle = 2, rotation.spin_free = true;
    loads.add(rotation);
    TwistLoad twist;
    twist.moment = 3, twist.rate = 2, twist.lateral_free = false, twist.axial_free = false;
    loads.add(twist.on_grip({end_of(5), end_of(6)}, 1));
    loads.add(twist.on_grip({topology.tube_begin[5], topology.tube_begin[6]}, -1));
  }
  Simulation make(double step = 0.01) const {
    return Simulation(topology, in, loads, state, step, 0.1, langevin(room, 2, 5));
  }
};

TEST(Langevin, GivesTheSameBitsOnAnyThreadsAndAfterAResume) {
  const LoadedBundle b;
  ASSERT_GT(b.state.size(), parallel_from);
  const auto run = [&](int threads) {
    omp_set_num_threads(threads);
    Simulation s = b.make();
    s.steps(300);
    EXPECT_GT(s.list().builds(), 1) << "the list was never rebuilt: the test shows less";
    return s.serialise();
  };
  const std::string one = run(1);
  for (const int threads : {2, 5}) EXPECT_EQ(run(threads) == one, true) << threads << " threads";
  Simulation whole = b.make(), resumed = b.make();
  whole.steps(120);
  resumed.restore(whole.serialise());
  resumed.steps(180);
  EXPECT_EQ(resumed.serialise() == one, true) << "after a resume";
  EXPECT_NE(resumed.heat(), 0);
}

TEST(Langevin, LeavesConstrainedComponentsAlone) {
  const LoadedBundle b;
  Simulation s = b.make();
  const Vector3 held = s.state().position[0];
  const auto grip = static_cast<std::size_t>(b.topology.tube_begin[1]);
  const Vector3 guided = s.state().position[grip];
  s.steps(300);
  EXPECT_EQ(s.state().position[0], held);
  EXPECT_EQ(s.state().orientation[0].coeffs(), b.state.orientation[0].coeffs());
  EXPECT_EQ(s.state().position[grip].x(), guided.x());
  EXPECT_EQ(s.state().position[grip].z(), guided.z());
  EXPECT_NE(s.state().position[grip].y(), guided.y());
  const auto turned = static_cast<std::size_t>(b.topology.tube_begin[5] - 1);
  const Vector3 v = s.state().velocity[turned], r = s.state().position[turned];
  EXPECT_NEAR(v.x(), -0.05 * r.y(), 1e-4);
  EXPECT_NEAR(v.y(), 0.05 * r.x(), 1e-4);
}

// The change of the total energy is the work of the loads and the heat, but for an error of the second order.
TEST(Langevin, HeatClosesTheAccountOfEnergy) {
  const LoadedBundle b;
  const auto unaccounted = [&](double step) {
    Simulation s = b.make(step);
    const double first = s.total_energy();
    s.steps(std::lround(6 / step));
    EXPECT_GT(std::fabs(s.heat()), 1);
    EXPECT_GT(std::fabs(s.work()), 0.1);
    return std::fabs(s.total_energy() - s.account().supplied() - first) / std::fabs(s.heat());
  };
  EXPECT_LT(unaccounted(0.004), 1e-3);
}

// Different numbers for each seed, step, element and component, and the same for the same.
TEST(Langevin, NoiseIsAFunctionOfSeedAndStep) {
  const Chain chain(3);
  const auto after = [&](std::uint64_t seed, std::int64_t step) {
    State s = chain.state;
    s.step = step;
    std::vector<double> none;
    LangevinThermostat(Schedule::always(room), 1, seed).apply(chain.topology, 0.01, s, none);
    return s;
  };
  const State a = after(1, 7), same = after(1, 7), seed = after(2, 7), step = after(1, 8);
  std::vector<double> all;
  for (const State* s : {&a, &seed, &step})
    for (const Vec3Array* v : {&s->velocity, &s->angular_velocity})
      for (const auto* c : {&v->x, &v->y, &v->z}) all.insert(all.end(), c->begin(), c->end());
  std::sort(all.begin(), all.end());
  EXPECT_EQ(std::adjacent_find(all.begin(), all.end()), all.end());
  EXPECT_EQ(a.velocity.x, same.velocity.x);
  EXPECT_EQ(a.angular_velocity.z, same.angular_velocity.z);
}

// The vectors that its authors publish.
TEST(Philox, HasItsKnownAnswers) {
  using Four = std::array<std::uint32_t, 4>;
  EXPECT_EQ(philox({0, 0, 0, 0}, 0), (Four{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
  const std::uint32_t ones = 0xffffffff;
  EXPECT_EQ(philox({ones, ones, ones, ones}, ~std::uint64_t{0}),
            (Four{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
  EXPECT_EQ(philox({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, 0x299f31d0a4093822),
            (Four{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

// x'' = -w^2 x at unit mass and kT.
struct Oscillator {
  double *x, *v, *v2_middle;
  double w2, keep;
  std::uint32_t step;
  EnergySupply supply = {};

  EnergySupply& account() { return supply; }
  void add_work_of_loads(double) {}
  double kinetic_energy() const { return 0.5 * *v * *v; }
  double damped(double) const { return 0; }
  void kick(double dt) { *v -= w2 * *x * dt; }
  void drift(double dt) { *x += *v * dt; }
  void bathe(double) {
    const auto bits = philox({step, 0, 0, 0}, 3);
    const double normal =
        std::sqrt(-2 * std::log(unit_interval(bits[0]))) * std::cos(2 * M_PI * unit_interval(bits[1]));
    *v = keep * *v + std::sqrt(1 - keep * keep) * normal;
    *v2_middle += *v * *v;
  }
};

// Far from small steps: w dt = 1.5, where that of velocities at the end of a step is 0.44 of the right value.
TEST(Verlet, SamplesOscillatorsExactlyAtAnyStableStep) {
  const double w2 = 4, dt = 0.75;
  double x = 0, v = 0, x2 = 0, v2 = 0, v2_middle = 0;
  constexpr std::uint32_t steps = 2000000;
  for (std::uint32_t k = 0; k < steps; ++k) {
    Oscillator oscillator{&x, &v, &v2_middle, w2, 0.6, k};
    begin_step(oscillator, dt, true);
    end_step(oscillator, dt);
    x2 += x * x;
    v2 += v * v;
  }
  EXPECT_NEAR(w2 * x2 / steps, 1, 0.01);
  EXPECT_NEAR(v2_middle / steps, 1, 0.01);
  EXPECT_NEAR(v2 / steps, 1 - w2 * dt * dt / 4, 0.01);
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
