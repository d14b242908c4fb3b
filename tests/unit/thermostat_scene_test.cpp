// The table [thermostat] of a scene: its keys, refusals and effects.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>

#include "model/error.hpp"
#include "scene/bath/thermostat.hpp"
#include "scene/prepare.hpp"
#include "scene/scene_toml.hpp"
#include "scene/term_damping.hpp"
#include "sim/forces/force_term.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

using ::testing::AllOf;
using ::testing::HasSubstr;

const std::string bath = "[thermostat]\ntemperature_K = 250\ncoupling_per_ps = 0.5\n";

Scene scene_from(const std::string& body) {
  return scene_of_text(
      "format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-tersoff\"\n[rope]\ntubes = 7\nlength_nm = 6.9\n" +
          body,
      ROPEWALK_SOURCE_DIR "/data/scenes/test.toml", {});
}

const ThermostatOptions& bath_of(const Scene& scene) { return scene.drives_of<ThermostatDrive>().at(0)->options; }

std::string refusal(const std::string& body) {
  try {
    scene_from(body);
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

TEST(ThermostatTable, IsRead) {
  const Scene s = scene_from("[start]\nseed = 4\n[run]\nduration_ps = 1\n" + bath);
  const ThermostatOptions& read = bath_of(s);
  EXPECT_EQ(read.method, "langevin");
  EXPECT_EQ(read.temperature.first(), 250);
  EXPECT_EQ(read.coupling, 0.5);
  EXPECT_EQ(read.seed, 4u) << "that of [start]";
  EXPECT_EQ(bath_of(scene_from("[run]\nduration_ps = 1\n" + bath + "seed = 9\n")).seed, 9u);
  EXPECT_FALSE(scene_from("[run]\nduration_ps = 1\n").bath());
}

TEST(ThermostatTable, ReachesTheSimulation) {
  Scene cold = scene_from("[run]\nduration_ps = 1\n"), warm = scene_from("[run]\nduration_ps = 1\n" + bath);
  const Prepared without = prepare(cold), with = prepare(warm);
  EXPECT_FALSE(without.stepping.thermostat);
  ASSERT_TRUE(with.stepping.thermostat);
  EXPECT_NEAR(with.time_step, step_of_excess(with.limit, warm_excess), 1e-12) << "the step of a warm scene";
  EXPECT_NEAR(without.time_step, cold_step_fraction * without.limit.limit, 1e-12);
  Simulation s = start(warm, with);
  s.steps(20);
  EXPECT_GT(s.heat(), 0);
}

TEST(ThermostatTable, RefusesWhatDoesNotGoWithIt) {
  const auto expect = [](const std::string& body, const char* words) {
    EXPECT_THAT(refusal(body), HasSubstr(words));
  };
  expect("[run]\nmode = \"relax\"\n" + bath, "run.mode: does not go with [thermostat]");
  expect("[damping]\npfc_local = 0.1\n[run]\nduration_ps = 1\n" + bath,
         "damping.pfc_local: does not go with [thermostat]");
  expect("[twist]\nmoment_nN_nm = 5\nrate_nN_nm_per_ps = 1\ngeometric_only = true\n" + bath,
         "twist.geometric_only: does not go with [thermostat]");
  const std::string run = "[run]\nduration_ps = 1\n[thermostat]\n";
  expect(run + "temperature_K = 300\n", "thermostat.coupling_per_ps: is missing");
  expect(run + "coupling_per_ps = 1\n", "thermostat.temperature_K: is missing");
  expect(run + "temperature_K = -1\ncoupling_per_ps = 1\n", "thermostat.temperature_K");
  expect(run + "temperature_K = [[0, 1], [0, 2]]\ncoupling_per_ps = 1\n", "has the time 0 ps in point 2");
  expect(run + "temperature_K = [[0, 1], [9, -2]]\ncoupling_per_ps = 1\n", "has the value -2 in point 2");
  expect(run + "temperature_K = 300\ncoupling_per_ps = 0\n", "thermostat.coupling_per_ps");
  expect(run + "temperature_K = 300\ncoupling_per_ps = 1\nmethod = \"berendsen\"\n", "thermostat.method");
}

std::string cooling(const std::string& body) {
  Scene scene = scene_from("[run]\nduration_ps = 1\n" + body);
  try {
    refuse_cooling(scene, prepare(scene));
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

// Whatever takes heat and gives none back: one rule for damping, friction and the terms of a user.
TEST(ThermostatTable, RefusesLossesWithoutNoise) {
  const std::string undamped = "[damping]\ncontact_viscosity_eV_ps_per_nm3 = 0\nbond_damping_per_ps = 0\n" + bath,
                    friction = "[[friction]]\nstrength_pN_per_nm = 10\nspin_strength_pN_per_nm = 10\n";
  EXPECT_EQ(cooling(undamped), "");
  EXPECT_EQ(cooling(undamped + friction), "");
  EXPECT_EQ(cooling(undamped + friction + "drag_eV_ps_per_nm3 = 0.01\n"), "") << "0.6 K of 250";
  const std::string drag = friction + "drag_eV_ps_per_nm3 = 3\n";
  EXPECT_THAT(cooling(undamped + drag),
              AllOf(HasSubstr("thermostat.temperature_K: is 250 K, and damping leaves the tubes at about "),
                    HasSubstr("set drag_eV_ps_per_nm3 of [[friction]] to 0")));
  EXPECT_EQ(cooling(undamped + drag + "[start]\nmay_cool = true\n"), "");
  EXPECT_THAT(cooling(bath), HasSubstr("bond_damping_per_ps of [damping] to 0"));
}

class Brake : public ForceTerm {
 public:
  std::unique_ptr<ForceTerm> copy() const override { return std::make_unique<Brake>(*this); }
  std::string name() const override { return "brake"; }
  TermSum add(const State& state, const Segment& part, const ForceRows& out) const override {
    for (int i = part.begin; i < part.end; ++i)
      out.force.add(static_cast<std::size_t>(i - out.origin), -20.0 * state.velocity[static_cast<std::size_t>(i)]);
    return {};  // says nothing of its power
  }
};

TEST(ThermostatTable, RefusesTheTermsOfAUserThatBrake) {
  Scene scene = scene_from(
      "[run]\nduration_ps = 1\n[damping]\ncontact_viscosity_eV_ps_per_nm3 = 0\nbond_damping_per_ps = 0\n" + bath);
  Prepared p = prepare(scene);
  EXPECT_NO_THROW(refuse_cooling(scene, p));
  add_term(std::make_shared<Brake>(), p.interaction);
  // Half of all motions decay at 20 over the mass.
  EXPECT_NEAR(damping_of_terms(p.topology, p.interaction, p.state, 250).at(0).rate, 10 / p.topology.types[0].mass,
              1.5 / p.topology.types[0].mass);
  try {
    refuse_cooling(scene, p);
    FAIL();
  } catch (const InputError& e) {
    EXPECT_THAT(e.what(), HasSubstr("take what brakes out of the force term \"brake\""));
  }
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
