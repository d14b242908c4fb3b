// The planner against a small chart made up for it: costs and errors are round figures to be added up by hand.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "io/files.hpp"
#include "model/error.hpp"
#include "plan/check.hpp"
#include "plan/planner.hpp"
#include "plan/scene_edit.hpp"
#include "scene/scene_toml.hpp"

namespace ropewalk {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* chart_folder = ROPEWALK_SOURCE_DIR "/tests/unit/chart";
const std::string head = "format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-tersoff\"\n";
const std::string bundle = head +
                           "[rope]\ntubes = 7\nlength_nm = 27.2  # long\n[twist]\nmoment_nN_nm = 8\n"
                           "rate_nN_nm_per_ps = 1\n[run]\n# time_step_fs = \"auto\"\n";
const std::string lone = head + "[chain]\nelements = 41\n[run]\nduration_ps = 20\n";

Scene scene_from(const std::string& text) { return scene_of_text(text, "scene.toml"); }

Plan planned(const std::string& text, double error, bool end_state = false,
             std::vector<std::string> observables = {}) {
  return plan_scene(scene_from(text), read_chart(chart_folder), {error, std::move(observables), end_state});
}

TEST(Chart, IsReadByTheNamesOfItsColumns) {
  const std::vector<ChartedScene> chart = read_chart(chart_folder);
  ASSERT_EQ(chart.size(), 2u);
  EXPECT_EQ(chart[0].models.size(), 14u);
  const ChartedModel& m = *chart[0].standard();
  EXPECT_EQ(m.name, "default");
  EXPECT_EQ(m.nodes, 6);
  EXPECT_EQ(m.time_step, 30);
  EXPECT_EQ(m.cpu_per_ns, 10);
  EXPECT_EQ(m.finest.at("energy").value, 100.5);
  EXPECT_EQ(m.finest.at("energy").error, 0.005);
  EXPECT_EQ(m.atoms.at("energy").reference, 95);
  EXPECT_EQ(m.atoms.count("beta"), 0u);
}

TEST(Chart, FaultsAreNamed) {
  const std::filesystem::path folder = std::filesystem::temp_directory_path() / "ropewalk-chart-test";
  std::filesystem::create_directories(folder);
  const std::string points = read_file(std::string(chart_folder) + "/points.csv"),
                    scenes = read_file(std::string(chart_folder) + "/scenes.csv");
  const auto fault = [&](const std::string& p, const std::string& s) {
    std::ofstream(folder / "points.csv") << p;
    std::ofstream(folder / "scenes.csv") << s;
    try {
      read_chart(folder.string());
    } catch (const InputError& e) {
      return std::string(e.what());
    }
    return std::string("read");
  };
  const auto with = [&](std::string text, const std::string& from, const std::string& to) {
    const auto at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return text.replace(at, from.size(), to);
  };
  EXPECT_EQ(fault(points, scenes), "read");
  EXPECT_EQ(fault(with(points, ",500,", ",inf,"), scenes), "read") << "no step was made: left out";
  EXPECT_THAT(fault(with(points, "cpu_s_per_ns", "cpu"), scenes),
              HasSubstr("cpu_s_per_ns: there is no such column"));
  EXPECT_THAT(fault(with(points, ",dynamics,20,", ",dynamics,"), scenes),
              HasSubstr("26 columns, the header has 27"));
  EXPECT_THAT(fault(with(points, "2.83", "x"), scenes),
              HasSubstr("points.csv:2: cutoff_nm: \"x\" is not a number"));
  EXPECT_THAT(fault(with(points, "finest,0", "oracle,0"), scenes), HasSubstr("neither finest nor md"));
  EXPECT_THAT(fault(points, with(scenes, "5,start", "5,zero")), HasSubstr("read"));
  EXPECT_THAT(fault(points, with(scenes, "5,start", "5,sea")), HasSubstr("energy_from: is neither start nor zero"));
  EXPECT_THAT(fault(points, with(scenes, "tube,0", "pipe,0")), HasSubstr("does not say what \"tube\" covers"));
  EXPECT_THAT(fault("", scenes), HasSubstr("is empty"));
  std::filesystem::remove_all(folder);
}

TEST(Plan, TakesTheCheapestThatHoldsTheError) {
  const Plan p = planned(bundle, 0.0125);
  EXPECT_EQ(p.stands_for, "bundle");
  EXPECT_TRUE(p.holds);
  // 0.4 % from the default's elements, 0.5 % from the longer step. Three nodes would be cheaper and hold the error
  // too.
  EXPECT_NEAR(p.expected.at("energy"), 0.009, 1e-9);
  EXPECT_NEAR(p.expected.at("beta"), 0, 1e-9);
  EXPECT_NEAR(p.cost, 0.7, 1e-9);
  EXPECT_EQ(p.ns_per_element_step, 500);
  EXPECT_NEAR(p.atoms.at("energy"), 5.5 / 95, 1e-6);
  const Scene s = scene_from(p.text);
  EXPECT_EQ(s.contact.nodes, 0) << "tubes would settle in their nodes";
  EXPECT_EQ(s.contact.cutoff, 0);
  EXPECT_EQ(s.element_length, scene_from(bundle).element_length);
  Scene standard = scene_from(bundle), own = s;
  EXPECT_NEAR(own.run.time_step / prepare(standard).time_step, 1.5, 0.01);
  EXPECT_THAT(p.text, HasSubstr("length_nm = 27.2  # long\n"));
}

TEST(Plan, GoesCoarserAndFinerWithTheError) {
  const Plan coarse = planned(bundle, 0.04);
  // Elements and steps are counted in the scene itself: half as many elements, and a longer stable step.
  EXPECT_LT(coarse.cost, 0.5 * 0.7 * 0.9);
  EXPECT_GT(coarse.cost, 0.2 * 0.7 * 0.9);
  EXPECT_NEAR(coarse.expected.at("energy"), 0.024 + 0.005 + 0.005, 1e-9);
  const Scene s = scene_from(coarse.text);
  // 19 bonds of the default's length become 10 (not 9.5) between the same ends.
  EXPECT_NEAR(10 * s.element_length, 19 * scene_from(bundle).element_length, 1e-7);
  EXPECT_NEAR(std::get<RopeSource>(s.source).length, 11 * s.element_length, 1e-7);
  EXPECT_EQ(s.contact.nodes, 0);
  EXPECT_EQ(s.contact.cutoff, 2.3);

  const Plan fine = planned(bundle, 0.0005);
  EXPECT_TRUE(fine.holds);
  EXPECT_GT(fine.cost, 2 * 2);
  EXPECT_EQ(scene_from(fine.text).contact.nodes, 0);
  EXPECT_NEAR(scene_from(fine.text).element_length / scene_from(bundle).element_length, 0.5, 1e-8);

  // Of the angle alone two per cent bear every knob that may be turned.
  const Plan angle = planned(bundle, 0.02, false, {"beta"});
  EXPECT_EQ(angle.expected.size(), 1u);
  EXPECT_NEAR(angle.expected.at("beta"), 0.01, 1e-9);
}

TEST(Plan, StartsFromTheDefaultWhateverTheSceneHas) {
  const std::string costly = bundle +
                             "time_step_fs = 3\ncontact_every = 2\nmass_scale = 9\nintegrator = \"rk4\"\n"
                             "[contact]\nnodes_per_element = 9\ncutoff_nm = 2.5\nprecision = \"double\"\n";
  const Plan p = planned(costly, 0.0125), same = planned(bundle, 0.0125);
  EXPECT_EQ(p.expected, same.expected);
  const Scene s = scene_from(p.text), t = scene_from(same.text);
  EXPECT_EQ(s.run.mass_scale, 1);
  EXPECT_EQ(s.run.stepping.contact_every, 1);
  EXPECT_FALSE(s.run.stepping.runge_kutta);
  EXPECT_EQ(s.contact.nodes, t.contact.nodes);
  EXPECT_EQ(s.contact.cutoff, 0);
  EXPECT_FALSE(s.contact.precision);
  EXPECT_EQ(s.run.time_step, t.run.time_step);
}

// Elements that must stay count as the next longer ones of the chart.
TEST(Plan, LongElementsThatStayHaveTheirPrice) {
  const auto of_length = [](double length) {
    return fmt::format(
        "{}element_length_nm = {}\n[rope]\ntubes = 7\nlength_nm = 40\n[[load]]\nkind = \"torque\"\nelements = [3]\n"
        "torque_nN_nm = [0, 0, 1]\n[run]\nduration_ps = 10\n",
        head, length);
  };
  const Plan p = planned(of_length(2.5), 0.0285);
  EXPECT_NEAR(p.expected.at("energy"), 0.024 + 0.001, 1e-9);
  EXPECT_EQ(scene_from(p.text).element_length, 2.5);
  const Plan longer = planned(of_length(5), 0.03);
  EXPECT_TRUE(longer.stands_for.empty());
  EXPECT_THAT(fmt::format("{}", fmt::join(longer.why, "\n")), HasSubstr("longer than any in scene bundle"));
}

TEST(Plan, KeepsEnoughElements) {
  std::string brief = bundle;
  brief.replace(brief.find("27.2"), 4, "13.6");
  const Plan p = planned(brief, 0.04);
  EXPECT_EQ(scene_from(p.text).element_length, scene_from(brief).element_length) << "five would be left";
  EXPECT_NEAR(p.cost, 0.7 * 0.9, 1e-9);
}

TEST(Plan, SaysWhatItCannotHold) {
  std::string text = bundle;
  const auto at = text.find("[twist]");
  text = text.substr(0, at) +
         "[[load]]\nkind = \"torque\"\nelements = [3]\ntorque_nN_nm = [0, 0, 1]\n[run]\n"
         "duration_ps = 10\n";
  const Plan p = planned(text, 0.001);  // the elements have numbers: they stay as they are
  EXPECT_FALSE(p.holds);
  EXPECT_NEAR(p.expected.at("energy"), 0.004, 1e-9);
  EXPECT_THAT(fmt::format("{}", fmt::join(p.why, "\n")), HasSubstr("a load names elements by number"));
}

TEST(Plan, ForAnEndStateTimeIsFree) {
  std::string still = bundle.substr(0, bundle.find("[twist]")) + "[run]\nduration_ps = 10\n";
  const Plan moving = planned(still, 0.02), end = planned(still, 0.02, true);
  EXPECT_EQ(scene_from(moving.text).run.mode, RunOptions::Mode::dynamics);
  EXPECT_EQ(scene_from(end.text).run.mode, RunOptions::Mode::relax);
  EXPECT_LT(end.cost, moving.cost);
  // A ramp needs its time, but not the tubes' own mass.
  std::string slow = bundle;
  slow.replace(slow.find("[run]"), 5, "hold_ps = 20\n[run]");
  const Plan ramped = planned(slow, 0.03, true);
  EXPECT_EQ(scene_from(ramped.text).run.mode, RunOptions::Mode::dynamics);
  EXPECT_EQ(scene_from(ramped.text).run.mass_scale, 100);
  EXPECT_EQ(scene_from(planned(slow, 0.03).text).run.mass_scale, 1);
  EXPECT_EQ(scene_from(planned(bundle, 0.03, true).text).run.mass_scale, 1) << "too fast for heavy tubes";
  std::string sudden = slow;
  sudden.replace(sudden.find("per_ps = 1"), 10, "per_ps = 0");
  EXPECT_EQ(scene_from(planned(sudden, 0.03, true).text).run.mass_scale, 1);
}

TEST(Plan, DropsTheContactOfALoneTube) {
  const Plan p = planned(lone, 0.05);
  EXPECT_EQ(p.stands_for, "tube");
  const Scene s = scene_from(p.text);
  EXPECT_EQ(s.contact.law, ContactOptions::Law::none);
  EXPECT_EQ(std::get<ChainSource>(s.source).elements, 10) << "four times as long, without loads";
  EXPECT_LT(p.cost, 0.3);
}

TEST(Plan, FallsBackWhereTheChartIsSilent) {
  const auto silent = [](const std::string& text, const char* why) {
    const Plan p = planned(text, 0.02);
    EXPECT_TRUE(p.stands_for.empty());
    EXPECT_FALSE(p.holds);
    EXPECT_TRUE(p.expected.empty());
    const std::string all = fmt::format("{}", fmt::join(p.why, "\n"));
    EXPECT_THAT(all, HasSubstr(why));
    EXPECT_THAT(all, HasSubstr("the default model is taken"));
    return scene_from(p.text);
  };
  std::string strong = bundle;
  strong.replace(strong.find("= 8\n"), 4, "= 35\n");
  strong += "time_step_fs = 5\n[contact]\nnodes_per_element = 4\n";
  const Scene s = silent(strong, "twist up to 0.05 rad/nm");
  EXPECT_EQ(s.run.time_step, 0);
  EXPECT_EQ(s.contact.nodes, 0);
  silent("format = \"ropewalk-scene-1\"\nparameters = \"cnt-20-20-tersoff\"\n" + bundle.substr(head.size()),
         "radius");
  silent("format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-paper\"\n" + bundle.substr(head.size()),
         "this scene has another");
  silent(bundle.substr(0, bundle.find("[run]")) + "geometric_only = true\n", "geometric_only");
}

TEST(Plan, RefusesObservablesThatTheChartLacks) {
  try {
    planned(bundle, 0.02, false, {"colour"});
    FAIL();
  } catch (const InputError& e) {
    EXPECT_THAT(e.what(), HasSubstr("choose of beta, energy"));
  }
}

TEST(Plan, IsRememberedInTheScene) {
  const Plan p = planned(bundle, 0.012);
  const auto remembered = expectations_of(p.text);
  EXPECT_EQ(remembered.size(), p.expected.size());
  for (const auto& [name, error] : p.expected) EXPECT_NEAR(remembered.at(name), error, 1e-6 * error);
  EXPECT_TRUE(expectations_of(bundle).empty());
}

TEST(SceneEdit, SetsKeysAndKeepsTheRest) {
  const std::string text = "a = 1\n# b = 2  # two\n\n[one]  # first\nc = 3\n# d = 4\n[[load]]\nc = 9\n[two]\n";
  EXPECT_EQ(with_key(text, "", "a", "5"), "a = 5  # planned\n" + text.substr(6));
  EXPECT_THAT(with_key(text, "", "b", "5"), HasSubstr("a = 1\nb = 5  # planned\n\n[one]"));
  EXPECT_THAT(with_key(text, "one", "c", "5"), HasSubstr("# first\nc = 5  # planned\n# d = 4\n[[load]]\nc = 9\n"));
  EXPECT_THAT(with_key(text, "one", "d", "5"), HasSubstr("c = 3\nd = 5  # planned\n[[load]]"));
  EXPECT_THAT(with_key(text, "two", "c", "5"), HasSubstr("c = 9\n[two]\nc = 5  # planned\n"));
  EXPECT_THAT(with_key(text, "three", "c", "5"), HasSubstr("[two]\n\n[three]\nc = 5  # planned\n"));
  EXPECT_THAT(without_key(text, "one", "c"), HasSubstr("[one]  # first\n# c = 3\n"));
  EXPECT_EQ(without_key(text, "two", "c"), text);
}

// A bent cantilever at rest: the finer model must find what beam theory says of the coarse one.
TEST(SpotCheck, SeesWhatLongElementsCost) {
  const auto checked = [](double length, int elements) {
    Scene scene = scene_from(fmt::format(
        "{}element_length_nm = {}\n[chain]\nelements = {}\n[contact]\nlaw = \"none\"\n"
        "[[load]]\nkind = \"fix\"\nelements = [0]\n[[load]]\nkind = \"torque\"\nelements = [-1]\n"
        "torque_nN_nm = [0, 8, 0]\n[run]\nmode = \"relax\"\nforce_tolerance_nN = 1e-6\nmax_steps = 400000\n",
        head, length, elements));
    const Prepared p = prepare(scene);
    Simulation s = start(scene, p);
    EXPECT_TRUE(s.relax(scene.run.force_tolerance, scene.run.max_steps, [](long) { return true; }));
    return spot_check(scene, p, s.state(), 1);
  };
  const SpotCheck coarse = checked(5, 9), fine = checked(2.5, 17);
  // A bond of the shear share s under a moment M holds d^2 (1/4 - 9 s/16) more than the beam, to the lowest order
  // of its bend d = M a/EI.
  const BondStiffness bond = scene_from(lone).parameters().bond;
  const auto excess = [&](double a) {
    const double d = 8 * units::nN_nm * a / bond.bend;
    return d * d * (0.25 - 0.5625 * bond.shear_share(a));
  };
  EXPECT_NEAR(coarse.observables.at("energy").error(), std::fabs(excess(5) - excess(2.5)), 2e-5);
  EXPECT_NEAR(fine.observables.at("energy").error(), std::fabs(excess(2.5) - excess(1.25)), 2e-6);
  EXPECT_GT(coarse.observables.at("energy").error(), 1e-3);
  EXPECT_LT(coarse.observables.at("bending_moment").error(), 0.01);
}

}  // namespace
}  // namespace ropewalk
