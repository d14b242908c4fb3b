// Bundles of tubes: conservation in undamped motion, what the damping may take and what not, restarts.
#include <gtest/gtest.h>
#include <omp.h>

#include "scene/ends/twist.hpp"
#include "scene/loads/fix.hpp"
#include "scene/loads/force.hpp"
#include "scene/loads/rotate.hpp"
#include "scene/loads/torque.hpp"
#include "sim/contact/line/law.hpp"
#include "sim/contact/paper/law.hpp"
#include "sim/dynamics/simulation.hpp"
#include "unit/support.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

constexpr double spacing = 1.713;

struct Bundle {
  Topology topology = test::published_topology();
  Interaction in;
  State state;

  Bundle(int tubes, int elements, double temperature) {
    state = test::disordered_bundle(topology, tubes, elements, spacing, 0, 1);
    in.law = paper_law(test::published_contact());
    test::set_velocities(topology, temperature, state);
  }
  double step(double part = default_step_fraction) const {
    return part * time_step_limit(topology, in, spacing).limit;
  }
  Simulation make(double dt) const { return Simulation(topology, in, {}, state, dt); }
};

Vector3 angular_momentum(const Simulation& s) {
  Vector3 sum = Vector3::Zero();
  for (std::size_t i = 0; i < s.state().size(); ++i)
    sum += s.topology().types[0].mass * s.state().position[i].cross(s.state().velocity[i]) +
           s.topology().types[0].inertia * s.state().angular_velocity[i];
  return sum;
}

// Sum of the magnitudes: what a change of the angular momentum is compared with.
double momentum_scale(const Simulation& s) {
  double sum = 0;
  for (std::size_t i = 0; i < s.state().size(); ++i)
    sum += s.topology().types[0].mass * s.state().position[i].norm() * s.state().velocity[i].norm() +
           s.topology().types[0].inertia * s.state().angular_velocity[i].norm();
  return sum;
}

struct Drift {
  double slope = 0;        // of the total energy by least squares, eV/ns
  double fluctuation = 0;  // root mean square about the line, eV
};

Drift energy_drift(Simulation& s, double ps) {
  const long steps = static_cast<long>(ps / s.time_step());
  const long every = std::max(1L, steps / 4000);
  double n = 0, st = 0, se = 0, stt = 0, ste = 0, see = 0;
  const double first = s.total_energy();
  for (long k = 0; k < steps; ++k) {
    s.step();
    if (k % every != 0) continue;
    const double t = s.state().time * 1e-3, e = s.total_energy() - first;
    n += 1, st += t, se += e, stt += t * t, ste += t * e, see += e * e;
  }
  Drift d;
  d.slope = (n * ste - st * se) / (n * stt - st * st);
  const double mean = se / n, variance = see / n - mean * mean;
  d.fluctuation = std::sqrt(std::max(variance - d.slope * d.slope * (stt / n - st * st / n / n), 0.0));
  return d;
}

class UndampedBundles : public ::testing::TestWithParam<Interaction::Precision> {};

TEST_P(UndampedBundles, EnergyAndAngularMomentumAreKeptOverOneNanosecond) {
  Bundle b(7, 5, 10);
  b.in.precision = GetParam();
  Simulation s = b.make(b.step());
  const double energy = std::fabs(s.total_energy());
  const Vector3 before = angular_momentum(s);
  const double scale = momentum_scale(s);
  const Drift d = energy_drift(s, 1000);
  EXPECT_LT(std::fabs(d.slope), 1e-4 * energy) << "energy " << energy << " eV, step " << b.step() << " ps";
  EXPECT_LT(d.fluctuation, 1e-4 * energy);
  // Rounded displacements of single precision are levers of forces that are a little too long or too short.
  const double bound = b.in.precision == Interaction::Precision::mixed ? 1e-5 : 1e-6;
  EXPECT_LT((angular_momentum(s) - before).norm(), bound * scale);
}

INSTANTIATE_TEST_SUITE_P(Precisions, UndampedBundles,
                         ::testing::Values(Interaction::Precision::full, Interaction::Precision::mixed),
                         [](const auto& info) {
                           return info.param == Interaction::Precision::full ? "Double" : "Mixed";
                         });

// The error of a symplectic scheme is an oscillation that falls as dt^2; half the step, a quarter of it.
TEST(UndampedBundle, EnergyErrorFallsWithTheSquareOfTheStep) {
  const Bundle b(7, 5, 10);
  Simulation coarse = b.make(0.016), fine = b.make(0.008);
  const double ratio = energy_drift(coarse, 300).fluctuation / energy_drift(fine, 300).fluctuation;
  EXPECT_NEAR(ratio, 4, 0.8);
}

// The test of the test: what the published code leaves out shows at once.
TEST(UndampedBundle, LegacyTorqueFeedsEnergyIn) {
  Bundle b(7, 5, 10);
  b.in.law = paper_law(test::published_contact(), true);
  Simulation s = b.make(0.02);
  const double first = s.total_energy();
  double gained = 0;
  try {
    for (int k = 0; k < 50000 && gained < 100; ++k) {
      s.step();
      gained = s.total_energy() - first;
    }
  } catch (const std::exception&) {
    gained = 1e9;  // blown up altogether
  }
  EXPECT_GT(gained, 100);
}

TEST(SpinningRope, DampingTakesNothing) {
  Bundle b(7, 20, 0);
  b.in.damping.contact = {20, spacing, 1.5 * spacing};
  b.in.damping.bond.rate = 1;
  Simulation still = b.make(b.step());
  ASSERT_TRUE(still.relax(1e-6, 50000, [](long) { return true; }));
  b.state = still.state();
  // Slow enough that the centrifugal strain does not matter; about an axis across the rope's own as well.
  const Vector3 omega(0.004, 0, 0.01);
  Vector3 centre = Vector3::Zero();
  for (std::size_t i = 0; i < b.state.size(); ++i)
    centre += b.state.position[i] / static_cast<double>(b.state.size());
  for (std::size_t i = 0; i < b.state.size(); ++i) {
    b.state.velocity.set(i, omega.cross(b.state.position[i] - centre));
    b.state.angular_velocity.set(i, omega);
  }
  Simulation s = b.make(b.step());
  const Vector3 before = angular_momentum(s);
  const double kinetic = kinetic_energy(s.topology(), s.state());
  s.steps(5000);
  EXPECT_LT((angular_momentum(s) - before).norm(), 1e-9 * before.norm());
  EXPECT_NEAR(kinetic_energy(s.topology(), s.state()) / kinetic, 1, 2e-3);
}

TEST(SpinningRope, LocalDampingDoesBrake) {
  Bundle b(7, 10, 0);
  b.in.damping.local = 0.3;
  for (std::size_t i = 0; i < b.state.size(); ++i) {
    b.state.velocity.set(i, Vector3(0, 0, 0.05).cross(b.state.position[i]));
    b.state.angular_velocity.set(i, {0, 0, 0.05});
  }
  Simulation s = b.make(b.step());
  const double before = angular_momentum(s).z();
  s.steps(5000);
  EXPECT_LT(angular_momentum(s).z(), 0.99 * before);
}

// total energy - work + dissipated stays, with every load and damping in play.
TEST(EnergyAccount, BalancesUnderLoadAndDamping) {
  Bundle b(7, 12, 0);
  b.in.damping.contact = {20, spacing, 1.5 * spacing};
  b.in.damping.bond.rate = 1;
  TwistLoad twist;
  twist.moment = 100;
  twist.rate = 10;
  using A = TwistLoad::Application;
  for (const auto application : {A::couple, A::follower, A::conservative, A::tangential}) {
    twist.application = application;
    LoadsAndConstraints loads;
    add_twist(twist, b.topology, loads);
    Simulation s(b.topology, b.in, loads, b.state, 0.005);
    const double first = s.total_energy();
    s.steps(4000);
    const double balance = s.total_energy() - s.work() + s.dissipated() - first;
    EXPECT_GT(s.work(), 50);
    EXPECT_GT(s.dissipated(), 1);
    EXPECT_LT(std::fabs(balance), 2e-3 * s.work()) << "work " << s.work() << " dissipated " << s.dissipated();
  }
}

// An end that is tilted by theta is led once around z and turns back about its axis: it is as before. Of the three
// couples only the conservative one has then done no work.
TEST(Twist, CouplesOnAClosedPath) {
  const auto work = [](TwistLoad::Application application, double theta) {
    TwistLoad twist;
    twist.moment = 10, twist.application = application;
    const TwistLoad load = twist.on_grip({0}, 1);
    const auto orientation = [&](double alpha) {
      return Quaternion(Eigen::AngleAxisd(alpha, Vector3::UnitZ()) * Eigen::AngleAxisd(-theta, Vector3::UnitX()) *
                        Eigen::AngleAxisd(-alpha, Vector3::UnitZ()));
    };
    constexpr int steps = 2000;
    const double h = 2 * units::pi / steps;
    double sum = 0;
    for (int k = 0; k < steps; ++k) {
      State state(1);
      state.orientation.set(0, orientation((k + 0.5) * h));
      std::vector<PointLoad> loads;
      load.add_forces(state, 0, loads);
      const Eigen::AngleAxisd turn(orientation((k + 1) * h) * orientation(k * h).conjugate());
      sum += loads.at(0).torque.dot(turn.angle() * turn.axis());
    }
    return sum;
  };
  using A = TwistLoad::Application;
  for (const double theta : {0.3, 1.0, 2.0}) {
    const double around = 10 * 2 * units::pi * (1 - std::cos(theta));
    EXPECT_NEAR(work(A::couple, theta), around, 1e-4 * around);
    EXPECT_NEAR(work(A::follower, theta), -around, 1e-4 * around);
    EXPECT_NEAR(work(A::conservative, theta), 0, 1e-4 * around);
  }
}

// The work of a conservative couple is the moment times the growth of psi, whatever the way.
TEST(Twist, TheWorkOfAConservativeCoupleFollowsFromItsPotential) {
  Bundle b(7, 12, 0.05);
  for (int t = 0; t < b.topology.tubes(); ++t)  // it sways
    for (int k = 0; k < 12; ++k)
      b.state.velocity.x[static_cast<std::size_t>(b.topology.tube_begin[t] + k)] = 1.5 * k * k / 121.0;
  TwistLoad twist;
  twist.moment = 150, twist.application = TwistLoad::Application::conservative;
  LoadsAndConstraints loads;
  add_twist(twist, b.topology, loads);
  Simulation s(b.topology, b.in, loads, b.state, 0.004);
  const auto psi = [&](int element) {
    const Quaternion q = s.state().orientation[static_cast<std::size_t>(element)];
    return 2 * std::atan2(q.z(), q.w());
  };
  std::vector<double> turned(static_cast<std::size_t>(b.topology.elements())), last = turned;
  for (int e = 0; e < b.topology.elements(); ++e) last[static_cast<std::size_t>(e)] = psi(e);
  double tilted = 0;
  for (int n = 0; n < 3000; ++n) {
    s.step();
    for (int e = 0; e < b.topology.elements(); ++e) {
      const auto i = static_cast<std::size_t>(e);
      const double now = psi(e);
      turned[i] += std::remainder(now - last[i], 2 * units::pi);
      last[i] = now;
    }
  }
  double expected = 0;
  for (int t = 0; t < b.topology.tubes(); ++t) {
    const auto first = static_cast<std::size_t>(b.topology.tube_begin[t]),
               end = static_cast<std::size_t>(b.topology.tube_begin[t + 1] - 1);
    expected += twist.moment * (turned[end] - turned[first]);
    tilted = std::max(tilted, std::acos(axis_of(s.state().orientation[end]).z()));
  }
  EXPECT_GT(tilted, 0.3) << "or the three couples are one";
  EXPECT_NEAR(s.work() / expected, 1, 1e-3);
}

TEST(EnergyAccount, PrescribedRotationDoesTheWork) {
  Bundle b(7, 12, 0);
  LoadsAndConstraints loads;
  PrescribedRotation upper, lower;
  for (int t = 0; t < 7; ++t) {
    lower.elements.push_back(b.topology.tube_begin[t]);
    upper.elements.push_back(b.topology.tube_begin[t + 1] - 1);
  }
  upper.rate = 0.02, upper.angle = 0.4;
  loads.add(upper);
  loads.add(lower);
  Simulation s(b.topology, b.in, loads, b.state, 0.005);
  const double first = s.total_energy();
  s.steps(5000);
  const auto u = static_cast<std::size_t>(b.topology.tube_begin[2] - 1);
  const Vector3 at = s.state().position[u], was = b.state.position[u];
  EXPECT_NEAR(std::atan2(at.y(), at.x()) - std::atan2(was.y(), was.x()), 0.4, 1e-3);
  EXPECT_GT(s.work(), 1);
  EXPECT_LT(std::fabs(s.total_energy() - s.work() - first), 5e-3 * s.work());
}

TEST(Checkpoint, GoesOnBitForBitOnAnyThreads) {
  Bundle b(7, 40, 300);
  b.in.damping.contact = {20, spacing, 1.5 * spacing};
  Simulation whole = b.make(b.step());
  whole.steps(700);
  const std::string saved = whole.serialise();
  whole.steps(700);
  Simulation resumed = b.make(b.step());
  resumed.restore(saved);
  resumed.steps(700);
  EXPECT_EQ(whole.serialise(), resumed.serialise());
  EXPECT_GT(whole.list().builds(), 1) << "the list was never rebuilt: the test shows nothing";
}

// A rope whose ends turn, by the line law.
struct TurnedRope {
  Bundle b;
  LoadsAndConstraints loads;

  explicit TurnedRope(double rate, int elements = 40) : b(7, elements, 0) {
    b.in.law = line_law({test::line_contact(0.6785, 6, 0.6785, 6)});
    b.in.precision = Interaction::Precision::mixed;
    b.in.damping.contact = {20, spacing, 1.5 * spacing};
    PrescribedRotation upper, lower;
    for (int t = 0; t < b.topology.tubes(); ++t) {
      lower.elements.push_back(b.topology.tube_begin[t]);
      upper.elements.push_back(b.topology.tube_begin[t + 1] - 1);
    }
    upper.rate = rate, upper.angle = 2;
    loads.add(upper);
    loads.add(lower);
  }
  Simulation make(double skin) const { return Simulation(b.topology, b.in, loads, b.state, 0.02, skin); }
};

// Lists that are worn soon get a wider skin than those that last; the motion is the same.
TEST(ListSkin, FollowsTheMotion) {
  const TurnedRope slow(0.004), fast(0.2);
  Simulation s = slow.make(0), f = fast.make(0), fixed = fast.make(0.3);
  for (int k = 0; k < 4000; ++k) s.step(false);
  for (int k = 0; k < 400; ++k) {
    f.step();
    fixed.step();
  }
  EXPECT_GT(s.list().builds(), 1);
  EXPECT_GT(f.list().builds(), 4);
  EXPECT_LT(s.list().skin, 0.8 * default_skin(slow.b.in));
  EXPECT_GT(f.list().skin, 1.2 * s.list().skin);
  EXPECT_EQ(fixed.list().skin, 0.3);
  EXPECT_GT(f.work(), 10);
  EXPECT_NEAR(f.work(), fixed.work(), 1e-5 * f.work());
  EXPECT_NEAR(f.total_energy(), fixed.total_energy(), 1e-5 * f.work());
}

// In slow motion most steps do not measure how far elements have come: known bounds hold all the same.
TEST(ListSkin, IsNeverUsedUpUnseen) {
  const TurnedRope rope(0.004);
  Simulation s = rope.make(0.3);
  const auto n = static_cast<std::ptrdiff_t>(rope.b.topology.elements());
  int unseen = 0;
  for (int k = 0; k < 3000; ++k) {
    s.step(false);
    const Change now = s.list().change(s.state(), 0, n);
    // `now` is found with the twist that fits best now, displacement() with that of the last check.
    ASSERT_LE(now.moved, s.list().displacement() + 1e-4) << k;
    if (s.list().displacement() > now.moved + 1.5e-4) ++unseen;
  }
  EXPECT_GT(unseen, 500);
}

TEST(Checkpoint, GoesOnWhereNobodyLooks) {
  const TurnedRope rope(0.004);
  Simulation whole = rope.make(0);
  whole.steps(300);
  for (int save = 0; save < 8; ++save) {
    whole.steps(1);
    Simulation resumed = rope.make(0), one_by_one = rope.make(0), on = whole;
    resumed.restore(whole.serialise());
    one_by_one.restore(whole.serialise());
    EXPECT_EQ(resumed.serialise(), whole.serialise());
    on.steps(60);
    resumed.steps(60);
    for (int k = 0; k < 60; ++k) one_by_one.step();
    ASSERT_EQ(resumed.serialise(), on.serialise()) << save;
    ASSERT_EQ(one_by_one.serialise(), on.serialise()) << save;
  }
}

// With all that acts on some elements alone, and types of tubes that the blocks of the motion are not aligned with.
LoadsAndConstraints all_kinds(const Topology& topology, bool geometric_only = false) {
  const auto end_of = [&](int tube) { return topology.tube_begin[tube + 1] - 1; };
  LoadsAndConstraints loads;
  loads.add(ForceLoad({3}, {0.1, 0, -0.2}));
  loads.add(TorqueLoad({3}, {0, 0.3, 0}));
  loads.add(ForceLoad({3}, {0, 0.1, 0}));
  loads.add(ForceLoad({end_of(2)}, {0, 0, 1}));
  loads.add(FixLoad({0}));
  loads.add(FixLoad({topology.tube_begin[1]}, true, false, true, false));
  PrescribedRotation turned;
  turned.elements = {end_of(4), end_of(3)};
  turned.rate = 0.05, turned.angle = 2, turned.spin_free = true;
  loads.add(turned);
  TwistLoad twist;
  twist.moment = 3, twist.rate = 2, twist.application = TwistLoad::Application::tangential;
  twist.lateral_free = false, twist.axial_free = false;
  twist.geometric_only = geometric_only, twist.increment = 0.3;
  loads.add(twist.on_grip({end_of(5), end_of(6)}, 1));
  loads.add(twist.on_grip({topology.tube_begin[5], topology.tube_begin[6]}, -1));
  return loads;
}

// So large that blocks of elements go on before the contact of others is there, and of tubes that are cut into
// parts.
TEST(Steps, OfALargeSceneAreTheSameBitsOnAnyThreads) {
  Bundle b(7, 3000, 300);
  ASSERT_GT(static_cast<std::size_t>(b.topology.elements()), large_scene);
  b.in.law = line_law({test::line_contact(0.6785, 6, 0.6785, 6)});
  b.in.precision = Interaction::Precision::mixed;
  b.in.damping.contact = {20, spacing, 1.5 * spacing};
  const auto run = [&](int threads, long at_once) {
    omp_set_num_threads(threads);
    Simulation s(b.topology, b.in, all_kinds(b.topology), b.state, 0.015, 0.02);
    for (long k = 0; k < 24; k += at_once) s.steps(at_once);
    EXPECT_GT(s.list().builds(), 2) << "the list was never rebuilt: the test shows less";
    return s.serialise();
  };
  const std::string one_by_one = run(1, 1);
  for (const int threads : {1, 2, 5}) EXPECT_EQ(run(threads, 12) == one_by_one, true) << threads << " threads";
}

TEST(Steps, ManyAtOnceAreTheSameBitsAsOneByOne) {
  const auto expect_same = [](const char* what, Simulation at_once, Simulation one_by_one) {
    SCOPED_TRACE(what);
    for (const long count : {1L, 2L, 150L, 37L}) {
      at_once.steps(count);
      for (long k = 0; k < count; ++k) one_by_one.step();
      ASSERT_EQ(at_once.serialise(), one_by_one.serialise()) << count;
    }
    EXPECT_GT(at_once.list().builds(), 1) << "the list was never rebuilt: the test shows less";
    EXPECT_GT(std::fabs(at_once.work()), 0.1);
    EXPECT_EQ(at_once.state().step, 190);
  };
  Bundle b(7, 83, 300);
  b.topology.types.push_back(b.topology.types[0]);
  b.topology.types[1].mass *= 1.5;
  b.topology.types[1].inertia *= 1.7;
  for (int t = 0; t < 7; t += 3) b.topology.tube_type[static_cast<std::size_t>(t)] = 1;
  b.in.law = line_law(std::vector<LineContact>(4, test::line_contact(0.6785, 6, 0.6785, 6)));
  b.in.precision = Interaction::Precision::mixed;
  b.in.damping.contact = {20, spacing, 1.5 * spacing};
  const LoadsAndConstraints loads = all_kinds(b.topology);
  const auto make = [&](Stepping stepping = {}) {
    return Simulation(b.topology, b.in, loads, b.state, 0.015, 0.1, stepping);
  };
  expect_same("driven", make(), make());
  b.in.damping.local = 0.3;
  expect_same("local damping", make(), make());
  b.in.damping.local = 0;
  const LoadsAndConstraints spins = all_kinds(b.topology, true);
  const Simulation relaxed(b.topology, b.in, spins, b.state, 0.015, 0.1);
  expect_same("relaxed spins", relaxed, relaxed);
}

TEST(Checkpoint, GoesOnWithTheSameLists) {
  const TurnedRope rope(0.1);
  Simulation whole = rope.make(0);
  long builds = 0;
  for (int save = 0; save < 3; ++save) {
    // Not far behind a new list, then on to the next ones.
    for (int k = 0; k < 150 + 37 * save; ++k) whole.step(false);
    Simulation resumed = rope.make(0);
    resumed.restore(whole.serialise());
    EXPECT_EQ(resumed.serialise(), whole.serialise());
    builds = whole.list().builds();
    for (int k = 0; k < 200; ++k) {
      whole.step(false);
      resumed.step(false);
    }
    EXPECT_EQ(resumed.serialise(), whole.serialise());
    EXPECT_GT(whole.list().builds(), builds);
  }
  EXPECT_NE(whole.list().skin, default_skin(rope.b.in));
}

// Helices whose neighbours cross at random angles.
// A drag on some elements: its force is that of the velocities in the middle of a step, which no state has.
class Drag : public Load {
 public:
  explicit Drag(std::vector<int> on) : Load(std::move(on)) {}
  std::shared_ptr<Load> copy() const override { return std::make_shared<Drag>(*this); }
  void add_forces(const State& state, double, std::vector<PointLoad>& out) const override {
    for (const int e : elements) {
      const auto i = static_cast<std::size_t>(e);
      out.push_back({e, -5 * state.velocity[i], -2 * state.angular_velocity[i]});
    }
  }
};

TEST(Checkpoint, GoesOnUnderALoadThatDependsOnVelocities) {
  const Bundle b(3, 10, 300);
  LoadsAndConstraints loads;
  loads.add(Drag({3, 4, 17}));
  for (const Stepping& stepping : {Stepping{}, Stepping{true}}) {
    const auto make = [&] { return Simulation(b.topology, b.in, loads, b.state, 0.01, 0, stepping); };
    Simulation whole = make(), resumed = make();
    whole.steps(50);
    resumed.restore(whole.serialise());
    EXPECT_EQ(resumed.serialise(), whole.serialise());
    whole.steps(50);
    resumed.steps(50);
    EXPECT_LT(whole.work(), -0.01);
    EXPECT_EQ(resumed.work(), whole.work());
    EXPECT_EQ(resumed.serialise(), whole.serialise());
  }
}

// Ends of a rope of thick and thin tubes that are held by their centre of mass: no work is left out of the account.
TEST(TwistLoad, HeldGripOfUnlikeTubesKeepsTheAccountClosed) {
  Bundle b(7, 10, 0);
  b.topology.types.push_back(b.topology.types[0]);
  b.topology.types[1].mass *= 0.2;
  b.topology.types[1].inertia *= 0.2;
  for (int t = 0; t < 4; ++t) b.topology.tube_type[static_cast<std::size_t>(t)] = 1;
  TwistLoad twist;
  twist.moment = 100, twist.rate = 20, twist.lateral_free = false;
  LoadsAndConstraints loads;
  add_twist(twist, b.topology, loads);
  loads.add(ForceLoad({5}, {3, 0, 0}));
  Simulation s(b.topology, b.in, loads, b.state, 0.004);
  const double first = s.total_energy();
  s.steps(2000);
  EXPECT_GT(s.work(), 10);
  EXPECT_NEAR(s.total_energy() - first, s.work(), 2e-3 * s.work());
  double mass = 0;
  Vector3 moved = Vector3::Zero();
  for (int t = 0; t < b.topology.tubes(); ++t) {
    const auto i = static_cast<std::size_t>(b.topology.tube_begin[t]);
    moved += b.topology.type_of(t).mass * (s.state().position[i] - b.state.position[i]);
    mass += b.topology.type_of(t).mass;
  }
  EXPECT_LT((moved / mass).head<2>().norm(), 1e-9);
  // A force that the grip bears counts as balanced.
  LoadsAndConstraints grip;
  TwistLoad at_rest = twist;
  at_rest.moment = 1e-9, at_rest.rate = 0;
  add_twist(at_rest, b.topology, grip);
  for (int t = 0; t < b.topology.tubes(); ++t)
    grip.add(ForceLoad({b.topology.tube_begin[t]}, b.topology.type_of(t).mass * Vector3(50, 0, 0)));
  Interaction none;
  EXPECT_LT(Simulation(b.topology, none, grip, b.state, 0.004).largest_force(), 1e-6);
}

TEST(Checkpoint, GoesOnInATwistedRope) {
  TurnedRope rope(0.1, 80);       // in several chunks
  constexpr double pitch = 0.12;  // rad/nm
  test::Random random(8);
  State& s = rope.b.state;
  for (std::size_t i = 0; i < s.size(); ++i) {
    const Vector3 p = s.position[i];
    const Quaternion by = test::turn(Vector3::UnitZ(), pitch * p.z());
    const Vector3 at = by * p, along = Vector3(-pitch * at.y(), pitch * at.x(), 1).normalized();
    s.position.set(i, at);
    s.orientation.set(i, test::turn(random.direction(), random.uniform(0, 0.1)) *
                             Quaternion::FromTwoVectors(Vector3::UnitZ(), along) * by * s.orientation[i]);
  }
  Simulation whole = rope.make(0);
  for (int save = 0; save < 3; ++save) {
    for (int k = 0; k < 200; ++k) whole.step(false);
    Simulation resumed = rope.make(0);
    resumed.restore(whole.serialise());
    EXPECT_EQ(resumed.serialise(), whole.serialise());
    for (int k = 0; k < 50; ++k) {
      whole.step(false);
      resumed.step(false);
    }
    EXPECT_EQ(resumed.serialise(), whole.serialise());
  }
}

TEST(Relaxation, FindsTheHexagonalBundle) {
  Bundle b(7, 10, 0);
  for (std::size_t i = 0; i < b.state.size(); ++i)
    b.state.position.set(i, Vector3(b.state.position[i].cwiseProduct(Vector3(1.05, 1.05, 1))));
  Simulation s = b.make(b.step());
  ASSERT_TRUE(s.relax(1e-5, 50000, [](long) { return true; }));
  EXPECT_NEAR((s.state().position[15] - s.state().position[5]).head<2>().norm(), spacing, 0.01);
}

TEST(SpinRelaxation, TakesAwayTwistAndNothingElse) {
  Bundle b(1, 30, 0);
  // A helix with twisted frames.
  for (int i = 0; i < 30; ++i) {
    const double angle = 0.15 * i;
    const Vector3 tangent = Vector3(-std::sin(angle), std::cos(angle), 1.2).normalized();
    b.state.position.set(i, {6 * std::cos(angle), 6 * std::sin(angle), 1.1 * i});
    const Quaternion q = Quaternion::FromTwoVectors(Vector3::UnitZ(), tangent);
    b.state.orientation.set(i, test::turn(tangent, 0.3 * std::sin(i)) * q);
  }
  State relaxed = b.state;
  relax_spins(b.topology, relaxed);
  for (int i = 0; i + 1 < 30; ++i) {
    EXPECT_NEAR(bond_twist_angle(frame_of(relaxed.orientation[i]), frame_of(relaxed.orientation[i + 1])), 0, 1e-12);
    EXPECT_LT((axis_of(relaxed.orientation[i]) - axis_of(b.state.orientation[i])).norm(), 1e-12);
  }
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
