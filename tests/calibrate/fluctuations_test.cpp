// Stiffnesses from motion: chains with known ones, drawn at random and moved by the thermostat.
#include "fluctuations/fluctuations.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <random>

#include "sim/dynamics/langevin.hpp"
#include "sim/dynamics/simulation.hpp"

namespace ropewalk::calibrate {
namespace {
namespace UNIT {

constexpr double room = 300;  // K
constexpr double kT = units::boltzmann * room;
constexpr double a = 1.356;

TEST(BondMotion, IsTheTurnAndTheShiftAboutTheMeanAxes) {
  State state(2);
  const Quaternion q(Eigen::AngleAxisd(0.7, Vector3(1, 2, -1).normalized()));
  const Vector3 turn(0.03, -0.05, 0.11), shift(0.01, -0.02, 1.4);
  const Quaternion half(Eigen::AngleAxisd(0.5 * turn.norm(), turn.normalized()));
  state.orientation.set(0, q);
  state.orientation.set(1, q * half * half);
  state.position.set(0, {1, 2, 3});
  state.position.set(1, Vector3(1, 2, 3) + q * half * shift);
  const BondMotion m = bond_motion(state, 0);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(m[k], shift[static_cast<Eigen::Index>(k)], 1e-12);
    EXPECT_NEAR(m[k + 3], turn[static_cast<Eigen::Index>(k)], 1e-12);
  }
}

// Bonds drawn from the canonical distribution of a rod whose stretch and twist are coupled and whose planes differ.
Fluctuation drawn(int frames, unsigned seed, double extra) {
  const double EA = 9000, GJ = 2000, D = 900, EI_x = 2500, EI_y = 1500;
  Eigen::Matrix2d k;
  k << EA, D, D, GJ;
  const Eigen::Matrix2d root = (kT * a * k.inverse()).llt().matrixL();
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  FluctuationSums sums(a);
  const int n = 30;
  for (int f = 0; f < frames; ++f) {
    State state(n);
    std::vector<double> own;
    for (int e = 0; e < n; ++e) own.push_back(extra * normal(random));
    for (int e = 0; e + 1 < n; ++e) {
      const auto i = static_cast<std::size_t>(e);
      const Eigen::Vector2d st = root * Eigen::Vector2d(normal(random), normal(random));
      const double bend = std::sqrt(kT * a / EI_x) * normal(random) + own[i + 1] - own[i];
      const Vector3 turn(bend, std::sqrt(kT * a / EI_y) * normal(random), st[1]);
      const Quaternion half(Eigen::AngleAxisd(0.5 * turn.norm(), turn.normalized()));
      state.orientation.set(i + 1, (state.orientation[i] * half * half).normalized());
      state.position.set(i + 1, state.position[i] + state.orientation[i] * half * Vector3(0, 0, a + st[0]));
    }
    sums.add_chain(state, 0, n);
    sums.end_frame();
  }
  return sums.evaluate(room);
}

TEST(Fluctuations, FindTheStiffnessesOfDrawnBonds) {
  const Fluctuation f = drawn(2000, 1, 0);
  const auto near = [](const Measured& m, double is) {
    EXPECT_LT(std::fabs(m.value - is), 3.5 * m.standard_error) << is;
    EXPECT_LT(m.standard_error, 0.06 * std::fabs(is));
  };
  ASSERT_EQ(f.windows.size(), 4u);
  for (const RodStiffness& k : {f.windows[0], f.rod}) {
    near(k.EA, 9000);
    near(k.GJ, 2000);
    near(k.EI_x, 2500);
    near(k.EI_y, 1500);
  }
  near(f.windows[0].coupling, 900);
  EXPECT_TRUE(f.local);
  EXPECT_LT(f.static_part, 0.02);
}

// Noise of the elements, as of means over few atoms, adds the same variance to every window: the rod keeps its
// stiffness, and the windows say that they do not agree.
TEST(Fluctuations, LeaveOutTheNoiseOfElements) {
  const Fluctuation f = drawn(4000, 2, 0.5 * std::sqrt(kT * a / 2500));
  EXPECT_LT(f.windows[0].EI_x.value, 0.75 * 2500);
  EXPECT_LT(std::fabs(f.rod.EI_x.value - 2500), 3.5 * f.rod.EI_x.standard_error);
  EXPECT_FALSE(f.local);
}

// Bonds that differ at rest, as those near the free ends of atoms and those of a bent tube, keep their stiffness.
TEST(Fluctuations, LeaveOutWhatBondsAreAtRest) {
  std::mt19937 random(4);
  std::normal_distribution<double> normal;
  FluctuationSums sums(a);
  const int n = 18;
  const double stretch = std::sqrt(kT * a / 9000), bend = std::sqrt(kT * a / 2500);
  for (int f = 0; f < 2000; ++f) {
    State state(n);
    for (std::size_t i = 0; i + 1 < n; ++i) {
      const bool end = i == 0 || i + 2 == n;
      const Vector3 turn(bend * (normal(random) + (i < n / 2 ? 1 : -1)), bend * normal(random), bend * normal(random));
      const Quaternion half(Eigen::AngleAxisd(0.5 * turn.norm(), turn.normalized()));
      state.orientation.set(i + 1, (state.orientation[i] * half * half).normalized());
      state.position.set(i + 1, state.position[i] + state.orientation[i] * half *
                                                        Vector3(0, 0, a + stretch * (normal(random) - (end ? 2 : 0))));
    }
    sums.add_chain(state, 0, n);
    sums.end_frame();
  }
  const Fluctuation found = sums.evaluate(room);
  for (const RodStiffness& k : found.windows) {
    EXPECT_LT(std::fabs(k.EA.value - 9000), 4 * k.EA.standard_error) << k.window;
    EXPECT_LT(std::fabs(k.EI_x.value - 2500), 4 * k.EI_x.standard_error) << k.window;
    EXPECT_LT(k.EA.standard_error, 0.06 * 9000);
  }
  EXPECT_TRUE(found.local);
  EXPECT_NEAR(found.static_part, 0.5, 0.02);
}

// Motion that is slower than a thirtieth of the time gives no error.
TEST(Fluctuations, SayWhereTheTimeIsTooShort) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  FluctuationSums sums(a);
  std::vector<double> bends(5, 0);
  for (int f = 0; f < 200; ++f) {
    State state(6);
    for (std::size_t i = 0; i < 5; ++i) {
      bends[i] = 0.95 * bends[i] + normal(random);
      const Vector3 vector = 1e-3 * Vector3(bends[i], normal(random), normal(random));
      const Quaternion turn(Eigen::AngleAxisd(vector.norm(), vector.normalized()));
      state.orientation.set(i + 1, (state.orientation[i] * turn).normalized());
      state.position.set(i + 1, state.position[i] + state.orientation[i] * Vector3(0, 0, a + 1e-3 * normal(random)));
    }
    sums.add_chain(state, 0, 6);
    sums.end_frame();
  }
  const Fluctuation found = sums.evaluate(room);
  EXPECT_TRUE(std::isnan(found.windows[0].EI_x.standard_error));
  EXPECT_TRUE(std::isfinite(found.windows[0].EA.standard_error));
  EXPECT_GT(found.frames_needed, 200);
}

TEST(Fluctuations, NeedFramesAndBonds) {
  FluctuationSums few(a), single(a);
  State state(3);
  for (std::size_t e = 0; e < 3; ++e) state.position.set(e, {0, 0, a * static_cast<double>(e)});
  for (int f = 0; f < 29; ++f) {
    few.add_chain(state, 0, 3);
    few.end_frame();
  }
  EXPECT_THROW(few.evaluate(room), std::invalid_argument);
  for (int f = 0; f < 40; ++f) {
    single.add_chain(state, 0, 2);
    single.end_frame();
  }
  EXPECT_THROW(single.evaluate(room), std::invalid_argument);
}

// 200 chains of this program at 300 K: their own stiffness lies within the standard error in 68 % of them, within
// two standard errors of that share, 6.6 %. Seed and number of frames were fixed before this run. Runs of another seed
// showed that 120 frames are too few: the errors of EA cover 60 % there.
TEST(Fluctuations, StandardErrorsCoverTheStiffnessOfTheModel) {
  constexpr int chains = 200, elements = 6;
  Topology topology;
  TubeType& type = topology.types[0];
  type.element_length = a;
  type.radius = 0.678;
  type.mass = 163.0 * a * units::carbon_mass;
  type.inertia = type.mass * type.radius * type.radius;
  type.bond = {1470.0 * units::nN_nm, 358.4 * units::nN_nm, 319.5 * units::nN_nm};
  type.bond.shear = thin_tube_shear(type.bond, type.radius);
  State state(chains * elements);
  for (int c = 0; c < chains; ++c) {
    topology.add_tube(elements);
    for (int e = 0; e < elements; ++e)
      state.position.set(static_cast<std::size_t>(c * elements + e), {10.0 * c, 0, a * e});
  }
  const Interaction none;
  Stepping stepping;
  stepping.thermostat = std::make_shared<LangevinThermostat>(Schedule::always(room), 8, 20261201);
  Simulation simulation(topology, none, {}, state, 0.2 * time_step_limit(topology, none, 0).limit, 0, stepping);
  std::vector<FluctuationSums> sums(chains, FluctuationSums(a));
  simulation.steps(400);
  for (int f = 0; f < 240; ++f) {
    simulation.steps(30);
    for (int c = 0; c < chains; ++c) {
      sums[static_cast<std::size_t>(c)].add_chain(simulation.state(), static_cast<std::size_t>(c * elements),
                                                  elements);
      sums[static_cast<std::size_t>(c)].end_frame();
    }
  }
  int EA = 0, EI = 0, GJ = 0;
  for (const FluctuationSums& sum : sums) {
    const Fluctuation f = sum.evaluate(room);
    const RodStiffness& k = f.windows.front();
    const auto covers = [](const Measured& m, double is) {
      return std::fabs(m.value - is) < m.standard_error ? 1 : 0;
    };
    EA += covers(k.EA, type.bond.stretch);
    EI += covers(k.EI_x, type.bond.bend);
    GJ += covers(k.GJ, type.bond.twist);
  }
  for (const auto& [name, covered] : {std::pair{"EA", EA}, std::pair{"EI", EI}, std::pair{"GJ", GJ}}) {
    const double share = covered / static_cast<double>(chains);
    EXPECT_NEAR(share, 0.683, 0.066) << name;
    std::cout << name << ": " << 100 * share << " % of the chains are covered\n";
  }
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk::calibrate
