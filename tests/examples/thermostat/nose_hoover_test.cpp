// The second example of docs/how-to/thermostat.md: a thermostat with internal variables.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "model/units.hpp"
#include "scene/prepare.hpp"
#include "scene/scene_toml.hpp"
#include "sim/dynamics/simulation.hpp"

namespace ropewalk {
namespace {

// [class]
// Two Nosé-Hoover thermostats in a chain: the first brakes or drives all N degrees of freedom, the second the first,
//
//   dv/dt = F/m - a v,   Q da/dt = 2 K - N kT - Q b a,   R db/dt = Q a^2 - kT,   Q = N kT t^2,   R = kT t^2,
//
// with the kinetic energy K and the time t of the response (ps). The variables are a, b (1/ps) and their integrals.
// G. J. Martyna, M. L. Klein, M. Tuckerman, J. Chem. Phys. 97, 2635 (1992), DOI 10.1063/1.463940.
class NoseHooverThermostat : public Thermostat {
 public:
  NoseHooverThermostat(double temperature, double response, int freedoms)
      : kT_(units::boltzmann * temperature),
        freedoms_(freedoms),
        mass_{freedoms * kT_ * response * response, kT_ * response * response} {}

  std::vector<double> initial_variables() const override { return {0, 0, 0, 0}; }

  void apply(const Topology& topology, double dt, State& state, std::vector<double>& variables) const override {
    double &a = variables[0], &b = variables[1];
    double twice = 2 * kinetic_energy(topology, state);  // 2 K, eV
    const auto drive_first = [&] {
      a *= std::exp(-0.25 * dt * b);
      a += 0.5 * dt * (twice - freedoms_ * kT_) / mass_[0];
      a *= std::exp(-0.25 * dt * b);
    };
    const auto drive_second = [&] { b += 0.5 * dt * (mass_[0] * a * a - kT_) / mass_[1]; };
    drive_second();
    drive_first();
    const double scale = std::exp(-dt * a);
    for (std::size_t i = 0; i < state.size(); ++i) {
      state.velocity.set(i, scale * state.velocity[i]);
      state.angular_velocity.set(i, scale * state.angular_velocity[i]);
    }
    twice *= scale * scale;
    variables[2] += dt * a;
    variables[3] += dt * b;
    drive_first();
    drive_second();
  }

  // eV; with the energy of the tubes it is constant.
  double energy(const std::vector<double>& v) const {
    return 0.5 * (mass_[0] * v[0] * v[0] + mass_[1] * v[1] * v[1]) + kT_ * (freedoms_ * v[2] + v[3]);
  }

 private:
  double kT_;
  int freedoms_;
  double mass_[2];  // Q and R, eV ps^2
};
// [class]

const char* const scene_text =
    "format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-tersoff\"\n[chain]\nelements = 10\n[start]\n"
    "temperature_K = 150\n[contact]\nlaw = \"none\"\n[damping]\ncontact_viscosity_eV_ps_per_nm2 = 0\n"
    "bond_damping_per_ps = 0\n[run]\nduration_ps = 1\ntime_step_fs = 3\n";
constexpr int freedoms = 6 * 10 - 3;  // the centre of mass stays where it is

std::shared_ptr<const NoseHooverThermostat> bath() {
  return std::make_shared<NoseHooverThermostat>(300, 0.5, freedoms);
}

Simulation simulation(std::shared_ptr<const Thermostat> bath) {
  Scene scene = scene_of_text(scene_text, ROPEWALK_SOURCE_DIR "/data/scenes/test.toml", {});
  Prepared p = prepare(scene);
  p.stepping.thermostat = std::move(bath);
  return start(scene, p);
}

// The tubes begin at half the temperature.
TEST(ThermostatExample, ANoseHooverChainHoldsTheTemperatureAndItsEnergy) {
  const auto bath = ropewalk::bath();
  Simulation s = simulation(bath);
  const auto conserved = [&] { return s.total_energy() + bath->energy(s.thermostat_variables()); };
  const double first = conserved(), kT = units::boltzmann * 300;
  s.steps(10000);
  double kinetic = 0, farthest = 0;
  constexpr int samples = 10000;
  for (int k = 0; k < samples; ++k) {
    s.steps(10);
    kinetic += kinetic_energy(s.topology(), s.state()) / samples;
    farthest = std::max(farthest, std::fabs(conserved() - first));
  }
  EXPECT_NEAR(2 * kinetic / (freedoms * kT), 1, 0.02);
  EXPECT_LT(farthest, 0.05 * freedoms * kT / 2);
  EXPECT_GT(s.heat(), 0.1 * kinetic);
}

TEST(ThermostatExample, ANoseHooverChainGoesOnFromACheckpoint) {
  Simulation whole = simulation(bath()), resumed = simulation(bath());
  whole.steps(200);
  resumed.restore(whole.serialise());
  EXPECT_EQ(resumed.thermostat_variables(), whole.thermostat_variables());
  EXPECT_NE(whole.thermostat_variables().front(), 0);
  whole.steps(200);
  resumed.steps(200);
  EXPECT_EQ(whole.serialise() == resumed.serialise(), true);
  Simulation other = simulation(nullptr);
  EXPECT_THROW(other.restore(whole.serialise()), std::runtime_error);
}

}  // namespace
}  // namespace ropewalk
