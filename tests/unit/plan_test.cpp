// The planner against a small chart made up for it: costs and errors are round figures to be added up by hand.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "io/files.hpp"
#include "model/error.hpp"
#include "observe/observe.hpp"
#include "plan/check.hpp"
#include "plan/expected_state.hpp"
#include "plan/features.hpp"
#include "plan/planner.hpp"
#include "plan/scene_edit.hpp"
#include "scene/dissipation.hpp"
#include "scene/kinds/rope.hpp"
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

// For what the knobs may add up to.
Plan planned(const std::string& text, double error, bool end_state = false,
             std::vector<std::string> observables = {}) {
  return plan_scene(scene_from(text), read_chart(chart_folder),
                    {error + between_scenes, std::move(observables), end_state});
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
  EXPECT_EQ(chart[0].driven_by, DrivenBy::load);
  EXPECT_EQ(chart[1].driven_by, DrivenBy::rotation);
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
  EXPECT_THAT(fault(points, with(scenes, "load,start", "load,zero")), HasSubstr("read"));
  EXPECT_THAT(fault(points, with(scenes, "load,start", "load,sea")),
              HasSubstr("energy_from: is neither start nor zero"));
  EXPECT_THAT(fault(points, with(scenes, "load,start", "wind,start")),
              HasSubstr("driven_by: is neither rotation nor"));
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
  EXPECT_NEAR(p.expected.at("energy"), 0.009 + between_scenes, 1e-9);
  EXPECT_NEAR(p.expected.at("beta"), between_scenes, 1e-9);
  EXPECT_NEAR(p.cost, 0.7, 1e-9);
  EXPECT_EQ(p.ns_per_element_step, 500);
  EXPECT_NEAR(p.atoms.at("energy"), 5.5 / 95, 1e-6);
  const Scene s = scene_from(p.text);
  EXPECT_EQ(s.contact.nodes, 0) << "tubes would settle in their nodes";
  EXPECT_EQ(s.contact.cutoff, 0);
  EXPECT_EQ(s.element_length, scene_from(bundle).element_length);
  Scene standard = scene_from(bundle), own = s;
  // 1.5 times the default's would be beyond the limit.
  EXPECT_NEAR(own.run.time_step / prepare(standard).limit.limit, 0.9, 1e-3);
  EXPECT_THAT(p.text, HasSubstr("length_nm = 27.2  # long\n"));
}

// A rope that a moment turns is not one whose ends are turned, however near it is in twist and size.
TEST(Plan, PrefersASceneThatIsLedInTheSameWay) {
  std::string rotated = bundle.substr(0, bundle.find("[twist]")) +
                        "[[load]]\nkind = \"fix\"\nelements = [0]\n[[load]]\nkind = \"rotate\"\nelements = [-1]\n"
                        "rate_deg_per_ps = 1\nangle_deg = 20\n[run]\nduration_ps = 30\n";
  std::vector<ChartedScene> chart = read_chart(chart_folder);
  ChartedScene turned = chart[0];  // in the middle between the two scenes
  turned.name = "turned";
  turned.driven_by = DrivenBy::rotation;
  chart[0].tubes = 91;
  chart.push_back(turned);
  const auto plan_of = [&](const std::string& text) {
    return plan_scene(scene_from(text), chart, {0.0125 + between_scenes, {}, false});
  };
  EXPECT_EQ(plan_of(bundle).stands_for, "bundle");
  EXPECT_EQ(plan_of(bundle).driven_otherwise, "");
  EXPECT_EQ(plan_of(rotated).stands_for, "turned");
  // Much shorter ropes come last of those.
  chart.push_back(turned);
  chart.back().name = "short";
  for (ChartedModel& m : chart.back().models) m.elements /= 4;
  chart[2].tubes = 19;
  EXPECT_EQ(plan_of(rotated).stands_for, "turned");
  for (ChartedModel& m : chart.back().models) m.elements *= 4;
  EXPECT_EQ(plan_of(rotated).stands_for, "short") << "which it is no more";
  chart.pop_back();
  chart.erase(chart.begin());
  const Plan p = plan_of(bundle);
  EXPECT_EQ(p.stands_for, "turned");
  EXPECT_THAT(p.driven_otherwise, HasSubstr("scene turned is driven by rotation, this one by load"));
  EXPECT_THAT(p.text, HasSubstr("# " + p.driven_otherwise));
}

TEST(Plan, HasTheDefaultModelBesides) {
  const std::string costly = bundle + "time_step_fs = 3\n[contact]\nnodes_per_element = 9\n";
  const Plan p = planned(costly, 0.0125);
  EXPECT_TRUE(p.standard_holds);
  EXPECT_NEAR(p.standard_expected.at("energy"), 0.005 + between_scenes, 1e-9);
  const Scene s = scene_from(p.standard_text);
  EXPECT_EQ(s.run.time_step, 0);
  EXPECT_EQ(s.contact.nodes, 0);
  EXPECT_NEAR(expectations_of(p.standard_text).errors.at("energy"), 0.005 + between_scenes, 1e-9);
  EXPECT_FALSE(planned(costly, 0.001).standard_holds);
  // It is taken where it holds the error and is no slower.
  EXPECT_TRUE(default_serves(p, 2, 1.9));
  EXPECT_TRUE(default_serves(p, 2, 2.1)) << "as good as equal";
  EXPECT_FALSE(default_serves(p, 1.7, 2));
  EXPECT_FALSE(default_serves(planned(costly, 0.001), 2, 1));
}

TEST(Plan, TakesNoLongStepOnTwoLevels) {
  std::vector<ChartedScene> chart = read_chart(chart_folder);
  for (ChartedModel& m : chart[0].models)
    if (m.name == "every-2") m.cpu_per_ns = 5;  // cheaper than the long step
  const Scene s = scene_from(plan_scene(scene_from(bundle), chart, {0.0125 + between_scenes, {}, false}).text);
  EXPECT_EQ(s.run.stepping.contact_every, 2);
  EXPECT_EQ(s.run.time_step, 0) << "the default part of the limit";
}

// A chart whose default took a smaller part of the limit than the program does.
TEST(Plan, StaysBelowTheStepLimit) {
  std::vector<ChartedScene> chart = read_chart(chart_folder);
  for (ChartedModel& m : chart[0].models)
    if (m.name == "step-0.9") m.time_step = 100;
  Scene s = scene_from(plan_scene(scene_from(bundle), chart, {0.0125 + between_scenes, {}, false}).text);
  const Prepared p = prepare(s);
  EXPECT_NEAR(s.run.time_step, 0.9 * inner_step_limit(p.limit, 1), 1e-3 * s.run.time_step);
  const std::string hot = bundle + "[start]\ntemperature_K = 50\n";
  Scene warm = scene_from(plan_scene(scene_from(hot), chart, {0.0125 + between_scenes, {}, false}).text);
  EXPECT_NEAR(warm.run.time_step, step_of_excess(prepare(warm).limit, warm_excess, 1), 1e-3 * warm.run.time_step);
}

TEST(Plan, EndMomentsThatLoadsGiveAreNotPromised) {
  std::vector<ChartedScene> chart = read_chart(chart_folder);
  for (ChartedModel& m : chart[0].models) m.finest["end_moment"] = m.finest.at("energy");
  const Plan p = plan_scene(scene_from(bundle), chart, {0.0125 + between_scenes, {}, false});
  EXPECT_EQ(p.expected.count("end_moment"), 0u);
  EXPECT_EQ(expectations_of(p.text).errors.count("end_moment"), 0u);
  EXPECT_THAT(fmt::format("{}", fmt::join(p.why, "\n")), HasSubstr("end_moment: loads give it here"));
}

// Two layers of a film that cross at one angle, and a rope, whose tubes are parallel.
TEST(SceneFeatures, HaveTheAnglesAtWhichTubesInReachCross) {
  Scene rope = scene_from(head + "[rope]\ntubes = 7\nlength_nm = 27.2\n[run]\nduration_ps = 5\n");
  EXPECT_NEAR(features_of(rope, prepare(rope)).crossing_to, 0, 1e-5);
  Prepared p = prepare(rope);
  const double angle = 0.6;
  p.topology.tube_begin.resize(3);
  p.topology.tube_type.resize(2);
  const auto half = p.topology.tube_begin[1];
  p.state = State(static_cast<std::size_t>(2 * half));
  for (int i = 0; i < 2 * half; ++i) {
    const double along = (i % half - 0.5 * half) * p.topology.types[0].element_length;
    const Quaternion turn(Eigen::AngleAxisd(i < half ? 0 : angle, Vector3::UnitX()));
    p.state.position.set(static_cast<std::size_t>(i),
                         turn * Vector3(0, 0, along) + Vector3(i < half ? 0 : p.spacing, 0, 0));
    p.state.orientation.set(static_cast<std::size_t>(i), turn);
  }
  const SceneFeatures f = features_of(rope, p);
  EXPECT_NEAR(f.crossing_from, angle / units::degree, 1e-5);
  EXPECT_NEAR(f.crossing_to, angle / units::degree, 1e-5);
}

// Helices of the same length, evenly twisted: no strain, no bond longer, the outer tubes at atan(R t).
TEST(ExpectedState, IsARopeThatHasBeenTwisted) {
  Scene scene = scene_from(bundle);
  const Prepared p = prepare(scene);
  const double turn = 0.04, rate = 0.002;
  const State s = turned_rope(p, turn, rate);
  const RopeObservation o =
      observe(p.topology, s, rope_shells(p.topology, p.state, 0), validities(scene, p.topology), 0, p.spacing);
  EXPECT_NEAR(o.beta, std::atan(p.spacing * turn), 1e-3);
  const double height = p.state.position[0].z() - p.state.position[p.topology.length_of(0) - 1].z();
  EXPECT_NEAR(o.geometric_twist, std::fabs(turn * height), 0.02);
  const auto energy = [&](const State& state) {
    return Simulation(p.topology, p.interaction, {}, state, p.time_step).forces().energy;
  };
  const double length = p.topology.tubes() * std::fabs(height);
  EXPECT_LT(energy(s).stretch, 1e-3 * energy(s).twist);
  EXPECT_NEAR(energy(s).twist, 0.5 * p.topology.types[0].bond.twist * turn * turn * length, 0.02 * energy(s).twist);
  // Velocities are those with which it goes on turning, without its growing shorter.
  const State later = turned_rope(p, turn + 1e-4 * rate, rate);
  for (std::size_t i = 0; i < s.size(); i += 17) {
    const Vector3 moved = (Vector3(later.position[i]) - Vector3(s.position[i])) / 1e-4;
    EXPECT_LT((moved - Vector3(s.velocity[i])).head<2>().norm(), 1e-2 * p.spacing * rate * std::fabs(height));
  }
}

// Two rows side by side that slide along one another lose as much per length, whatever the elements; and so does a
// chain that is sheared evenly, by bonds of the rate l a^2 each with its relative velocity over a.
TEST(Dissipation, BelongsToALengthOfTube) {
  const double spacing = 1.7;
  Damping d;
  d.contact = {20, spacing, 1.5 * spacing};
  d.bond.rate = 3;
  const auto power = [&](const Damping& of, double a) {
    double sum = 0;
    for (int k = -9; k <= 9; ++k)
      sum +=
          of.contact.force({spacing, 0, k * a}, Vector3::Zero(), Vector3::Zero(), Vector3::UnitZ(), Vector3::Zero())
              .power;
    return sum / a;
  };
  for (const double a : {0.4, 0.678, 2.7, 5.4}) {
    const Damping other = same_dissipation(d, 1.356, a);
    EXPECT_NEAR(power(other, a), power(d, 1.356), 1e-9 * std::fabs(power(d, 1.356)));
    EXPECT_NEAR(other.bond.rate * a * a, 3 * 1.356 * 1.356, 1e-9);
  }
}

TEST(Plan, GoesCoarserAndFinerWithTheError) {
  const Plan coarse = planned(bundle, 0.04);
  // Elements and steps are counted in the scene itself: half as many elements, and a longer stable step.
  EXPECT_LT(coarse.cost, 0.5 * 0.7 * 0.9);
  EXPECT_GT(coarse.cost, 0.2 * 0.7 * 0.9);
  EXPECT_NEAR(coarse.expected.at("energy"), 0.024 + 0.005 + 0.005 + between_scenes, 1e-9);
  const Scene s = scene_from(coarse.text);
  // 19 bonds of the default's length become 10 (not 9.5) between the same ends.
  EXPECT_NEAR(10 * s.element_length, 19 * scene_from(bundle).element_length, 1e-7);
  EXPECT_NEAR(dynamic_cast<const RopeSource&>(*s.source).length, 11 * s.element_length, 1e-7);
  EXPECT_EQ(s.contact.nodes, 0);
  EXPECT_EQ(s.contact.cutoff, 2.3);
  // Long elements have fewer bonds and pairs: the same dissipation per length needs other constants.
  const double times = s.element_length / scene_from(bundle).element_length;
  EXPECT_NEAR(s.damping.bond.rate, 1 / (times * times), 1e-5);
  EXPECT_GT(s.damping.contact.eta, 0.7 * 20 * times * times);
  EXPECT_LT(s.damping.contact.eta, 1.3 * 20 * times * times);

  const Plan fine = planned(bundle, 0.0005);
  EXPECT_TRUE(fine.holds);
  EXPECT_GT(fine.cost, 2 * 2);
  EXPECT_EQ(scene_from(fine.text).contact.nodes, 0);
  EXPECT_NEAR(scene_from(fine.text).element_length / scene_from(bundle).element_length, 0.5, 1e-8);

  // Of the angle alone two per cent bear every knob that may be turned.
  const Plan angle = planned(bundle, 0.02, false, {"beta"});
  EXPECT_EQ(angle.expected.size(), 1u);
  EXPECT_NEAR(angle.expected.at("beta"), 0.01 + between_scenes, 1e-9);
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
  EXPECT_NEAR(p.expected.at("energy"), 0.024 + 0.001 + between_scenes, 1e-9);
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
  EXPECT_NEAR(p.expected.at("energy"), 0.004 + between_scenes, 1e-9);
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
  EXPECT_EQ(s.contact.law, "none");
  EXPECT_EQ(s.source->sizes(s.element_length).elements, 10) << "four times as long, without loads";
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
  EXPECT_NEAR(expectations_of(p.text).asked, 0.012 + between_scenes, 1e-9);
  const auto remembered = expectations_of(p.text).errors;
  EXPECT_EQ(remembered.size(), p.expected.size());
  for (const auto& [name, error] : p.expected) EXPECT_NEAR(remembered.at(name), error, 1e-6 * error);
  EXPECT_TRUE(expectations_of(bundle).errors.empty());
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

TEST(SceneEdit, SetsValuesAtPathsAndKeepsTheRest) {
  const std::string text =
      "a = 1  # é\n[one]\nc = { x = 1, y = \"é\", z = [1, 2] }  # c\n# d = 4\n[[load]]\nc = [[0, 0],\n [1, 2]]  # l\n"
      "[[load]]\nc = 9\n";
  const auto set = [&](const char* path, const char* value) { return with_value(text, path, value, "s.toml"); };
  EXPECT_THAT(set("a", "2"), HasSubstr("a = 2  # é\n[one]"));
  EXPECT_THAT(set("one.c.x", "7"), HasSubstr("{ x = 7, y = \"é\", z = [1, 2] }  # c"));
  EXPECT_THAT(set("one.c.z.1", "7"), HasSubstr("y = \"é\", z = [1, 7] }  # c"));
  EXPECT_THAT(set("one.c.w", "7"), HasSubstr("c = { w = 7, x = 1,"));
  EXPECT_THAT(set("one.c", "7"), HasSubstr("[one]\nc = 7  # c\n"));
  EXPECT_THAT(set("one.d", "5"), HasSubstr("\nd = 5\n[[load]]"));
  EXPECT_THAT(set("load.0.c", "[]"), HasSubstr("[[load]]\nc = []  # l\n[[load]]\nc = 9\n"));
  EXPECT_THAT(set("load.1.c", "[8]"), HasSubstr("  # l\n[[load]]\nc = [8]\n"));
  EXPECT_THAT(set("load.1.e", "8"), HasSubstr("[[load]]\ne = 8\nc = 9\n"));
  EXPECT_THAT(set("new.deep.key", "1"), HasSubstr("c = 9\n\n[new]\ndeep.key = 1\n"));
  EXPECT_THAT(set("b", "1"), HasSubstr("b = 1\na = 1"));
  for (const char* wrong : {"load.2.c", "load.x.c", "load", "one", "a.b"})
    EXPECT_THROW(set(wrong, "1"), InputError) << wrong;
}

// A bent cantilever of harmonic bonds at rest: the finer model must find what beam theory says of the coarse one.
TEST(SpotCheck, SeesWhatLongElementsCost) {
  const auto checked = [](double length, int elements) {
    Scene scene = scene_from(fmt::format(
        "{}element_length_nm = {}\n[chain]\nelements = {}\n[contact]\nlaw = \"none\"\n"
        "[bond]\nlaw = \"harmonic\"\n[[load]]\nkind = \"fix\"\nelements = [0]\n[[load]]\nkind = "
        "\"torque\"\nelements = [-1]\n"
        "torque_nN_nm = [0, 8, 0]\n[run]\nmode = \"relax\"\nforce_tolerance_nN = 1e-8\nmax_steps = 400000\n",
        head, length, elements));
    const Prepared p = prepare(scene);
    Simulation s = start(scene, p);
    EXPECT_TRUE(s.relax(scene.run.goal.force, scene.run.max_steps, [](long) { return true; }));
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

// A rope at rest, and no knob turned: halves of elements see the same shape.
TEST(SpotCheck, LooksAtSpacingAndEndAngleOfARope) {
  Scene scene = scene_from(head + "[rope]\ntubes = 7\nlength_nm = 13.6\n[run]\nduration_ps = 1\n");
  const Prepared p = prepare(scene);
  const SpotCheck check = spot_check(scene, p, turned_rope(p, 0.02, 0), 0.2);
  const SpotCheck::Comparison spacing = check.observables.at("spacing"), angle = check.observables.at("end_angle");
  EXPECT_NEAR(spacing.planned, p.spacing, 0.01 * p.spacing);
  EXPECT_LT(spacing.error(), 2e-3);
  EXPECT_NEAR(angle.planned, 0.02 * 13.6 / units::degree, 2);
  EXPECT_LT(angle.error(), 0.05);
}

}  // namespace
}  // namespace ropewalk
