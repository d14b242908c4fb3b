// The step of warm scenes: how much hotter velocity Verlet leaves positions than velocities.
#include <gtest/gtest.h>

#include <cmath>

#include "scene/prepare.hpp"
#include "sim/contact/line/law.hpp"
#include "sim/dynamics/langevin.hpp"
#include "sim/dynamics/simulation.hpp"
#include "unit/support.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

constexpr double room = 300;  // K

struct Excess {
  double stretch = 0, shear = 0, bend = 0, twist = 0;

  double largest() const { return std::max({stretch, shear, bend, twist}); }
};

// A straight tube with the bonds of the calibrated (10,10) set, in a bath.
struct WarmChain {
  Topology topology = test::published_topology();
  State state;

  explicit WarmChain(int elements) {
    topology.types[0].bond = {1519 * units::nN_nm, 362.9 * units::nN_nm, 330.1 * units::nN_nm,
                              355.3 * units::nN_nm};
    topology.add_tube(elements);
    state = State(static_cast<std::size_t>(elements));
    for (std::size_t i = 0; i < state.size(); ++i)
      state.position.z[i] = test::element_length * static_cast<double>(i);
  }
  TimeStepLimit limit() const { return time_step_limit(topology, {}, 0); }

  // Temperature of each kind of bond energy over that of the velocities of the same motion, less 1: along z for
  // stretch, about z for twist, all others for shear and bend. Stretch and twist have one quadratic term in a bond,
  // shear and bend two.
  Excess measured(double step, int samples) const {
    Stepping stepping;
    stepping.thermostat = std::make_shared<LangevinThermostat>(Schedule::always(room), 8, 1);
    Simulation s(topology, {}, {}, state, step, 0, stepping);
    s.steps(static_cast<long>(30 / step));
    Energies sum;
    double along = 0, about = 0, sideways = 0;  // kinetic energy
    const TubeType& type = topology.types[0];
    for (int k = 0; k < samples; ++k) {
      s.steps(10);
      const Energies& e = s.forces().energy;
      sum.stretch += e.stretch;
      sum.shear += e.shear;
      sum.bend += e.bend;
      sum.twist += e.twist;
      double z = 0, turn = 0;
      for (std::size_t i = 0; i < state.size(); ++i) {
        z += 0.5 * type.mass * std::pow(s.state().velocity[i].z(), 2);
        turn += 0.5 * type.inertia * std::pow(s.state().angular_velocity[i].z(), 2);
      }
      along += z;
      about += turn;
      sideways += kinetic_energy(topology, s.state()) - z - turn;
    }
    const double bonds = topology.bonds(), n = topology.elements();
    return {sum.stretch / bonds / (along / n) - 1, sum.shear / (2 * bonds) / (sideways / (4 * n)) - 1,
            sum.bend / (2 * bonds) / (sideways / (4 * n)) - 1, sum.twist / bonds / (about / n) - 1};
  }
};

// At 0.6 of the limit stretch is a quarter hotter. Statistical errors: 1 % (standard deviation).
TEST(WarmStep, KeepsTheBondsAsWarmAsTheVelocities) {
  const WarmChain chain(24);
  const TimeStepLimit limit = chain.limit();
  const double warm = step_of_excess(limit, warm_excess), before = default_step_fraction * limit.limit;
  const Excess old = chain.measured(before, 20000), now = chain.measured(warm, 60000);
  const auto record = [](const char* name, const Excess& e, double step) {
    std::printf("%s, %.3g fs: stretch %+.1f %%, shear %+.1f %%, bend %+.1f %%, twist %+.1f %%\n", name,
                step / units::fs, 100 * e.stretch, 100 * e.shear, 100 * e.bend, 100 * e.twist);
  };
  record("0.6 of the limit", old, before);
  record("warm step", now, warm);
  EXPECT_GT(old.stretch, 0.15);
  EXPECT_LT(old.largest(), excess_of_positions(limit, before) + 0.03);
  for (const double kind : {now.stretch, now.shear, now.bend, now.twist}) {
    EXPECT_LT(kind, warm_excess + 0.02);
    EXPECT_GT(kind, -0.02);
  }
}

// Stretch alone: w^2 = 4 EA/(a m) sin^2(q/2), whose mean of 1/(1 - (w h)^2/4) is 1/sqrt(1 - (h w_max/2)^2).
TEST(WarmStep, IsThatOfTheClosedFormWhereStretchIsStiffest) {
  WarmChain chain(2);
  BondStiffness& bond = chain.topology.types[0].bond;
  bond.bend = bond.twist = 1e-6 * bond.stretch;
  bond.shear = 0;
  const TimeStepLimit limit = chain.limit();
  for (const double part : {0.2, 0.4, 0.6})
    EXPECT_NEAR(excess_of_positions(limit, part * limit.limit) / (1 / std::sqrt(1 - part * part) - 1), 1, 0.02);
  const double step = step_of_excess(limit, 0.05);
  EXPECT_NEAR(excess_of_positions(limit, step), 0.05, 1e-6);
}

// Energy of a chain under bond damping alone, against what the estimate says is left.
TEST(HeatLeft, IsWhatDampingLeavesOfTheEnergy) {
  WarmChain chain(60);
  test::set_velocities(chain.topology, room, chain.state);
  Interaction in;
  in.damping.bond.rate = 2;
  const TimeStepLimit limit = time_step_limit(chain.topology, in, 0);
  Simulation s(chain.topology, in, {}, chain.state, 0.2 * limit.limit, 0, {});
  const double first = s.total_energy();
  for (const double time : {0.3, 1.0}) {
    s.steps(std::lround((time - s.state().time) / s.time_step()));
    const double left = s.total_energy() / first, said = heat_left(limit, s.state().time);
    EXPECT_NEAR(left, said, 0.1) << time;
  }
  EXPECT_EQ(heat_left(time_step_limit(chain.topology, {}, 0), 100), 1);
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
