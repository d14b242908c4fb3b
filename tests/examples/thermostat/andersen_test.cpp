// The worked example of docs/how-to/thermostat.md: a second thermostat through the hook of the integrator.
#include <gtest/gtest.h>
#include <omp.h>

#include <cmath>

#include "model/units.hpp"
#include "scene/prepare.hpp"
#include "scene/scene_toml.hpp"
#include "model/counter_random.hpp"
#include "sim/dynamics/simulation.hpp"

namespace ropewalk {
namespace {

// [class]
// Andersen's thermostat: an element meets the bath at the rate nu (1/ps) and leaves it with the velocities of
// Maxwell's distribution. H. C. Andersen, J. Chem. Phys. 72, 2384 (1980), DOI 10.1063/1.439486.
class AndersenThermostat : public Thermostat {
 public:
  AndersenThermostat(double temperature, double rate, std::uint64_t seed)
      : kT_(units::boltzmann * temperature), rate_(rate), seed_(seed) {}

  void apply(const Topology& topology, double dt, State& state, std::vector<double>&) const override {
    const double probability = -std::expm1(-rate_ * dt);
    for (std::size_t i = 0; i < state.size(); ++i) {
      const auto bits = random_bits(state, i, 0);
      if (unit_interval(bits[0]) >= probability) continue;
      const TubeType& type = topology.type_of_element(static_cast<int>(i));
      const auto a = random_bits(state, i, 1), b = random_bits(state, i, 2);
      const auto n = normal_pair(a[0], a[1]), m = normal_pair(a[2], a[3]), o = normal_pair(b[0], b[1]);
      state.velocity.set(i, std::sqrt(kT_ / type.mass) * Vector3(n[0], n[1], m[0]));
      state.angular_velocity.set(i, std::sqrt(kT_ / type.inertia) * Vector3(m[1], o[0], o[1]));
    }
  }

 private:
  // A function of seed, step, part of the step and element: the same on any number of threads, and in a resumed run.
  std::array<std::uint32_t, 4> random_bits(const State& state, std::size_t element, std::uint32_t draw) const {
    return philox({static_cast<std::uint32_t>(state.step), static_cast<std::uint32_t>(state.step >> 32),
                   static_cast<std::uint32_t>(element), 3 * static_cast<std::uint32_t>(state.part) + draw},
                  seed_);
  }

  double kT_, rate_;
  std::uint64_t seed_;
};
// [class]

const char* const scene_text =
    "format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-tersoff\"\n[chain]\nelements = 10\n"
    "[contact]\nlaw = \"none\"\n[damping]\ncontact_viscosity_eV_ps_per_nm2 = 0\nbond_damping_per_ps = 0\n"
    "[run]\nduration_ps = 1\ntime_step_fs = 3\n";

Simulation simulation() {
  Scene scene = scene_of_text(scene_text, ROPEWALK_SOURCE_DIR "/data/scenes/test.toml", {});
  Prepared p = prepare(scene);
  // [use]
  p.stepping.thermostat = std::make_shared<AndersenThermostat>(300, 2, 1);
  return start(scene, p);
  // [use]
}

TEST(ThermostatExample, AndersenHoldsTheTemperature) {
  Simulation s = simulation();
  s.steps(10000);
  const double first = s.total_energy() - s.account().supplied();
  double kinetic = 0, bonds = 0;
  constexpr int samples = 20000;
  for (int k = 0; k < samples; ++k) {
    s.steps(10);
    kinetic += kinetic_energy(s.topology(), s.state()) / samples;
    bonds += s.forces().energy.bonds() / samples;
  }
  const double kT = units::boltzmann * 300;
  EXPECT_NEAR(kinetic / (3 * kT * s.topology().elements()), 1, 0.02);
  EXPECT_NEAR(bonds / (3 * kT * s.topology().bonds()), 1, 0.02);
  EXPECT_NEAR(s.total_energy() - s.account().supplied(), first, 0.02 * kinetic);
}

TEST(ThermostatExample, AndersenGoesOnWithTheSameBits) {
  omp_set_num_threads(1);
  Simulation whole = simulation(), resumed = simulation();
  whole.steps(200);
  resumed.restore(whole.serialise());
  omp_set_num_threads(2);
  whole.steps(200);
  resumed.steps(200);
  EXPECT_EQ(whole.serialise() == resumed.serialise(), true);
  EXPECT_NE(whole.heat(), 0);
}

}  // namespace
}  // namespace ropewalk
