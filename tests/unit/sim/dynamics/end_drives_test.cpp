// One rope said in several ways: by [twist], by grips and by loads on ends. What is forecast, watched, logged and
// asked of theory is the same.
#include "sim/dynamics/end_drives.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <map>

#include "campaign/threshold.hpp"
#include "model/error.hpp"
#include "plan/features.hpp"
#include "plan/forecast.hpp"
#include "plan/rest_theory.hpp"
#include "run/moving_scene.hpp"
#include "run/run_directory.hpp"
#include "scene/scene_toml.hpp"
#include "scene/watch.hpp"
#include "unit/support.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

using ::testing::Contains;
using ::testing::HasSubstr;

// --- Ways to write a couple of 32 nN nm on each of 19 tubes ---

std::string grip(const std::string& end, const std::string& about_z, const std::string& more = "") {
  return fmt::format(
      "[[grip]]\nend = \"{}\"\nas = \"each\"\nsmooth_ps = 0\nx = \"free\"\ny = \"free\"\nz = \"free\"\n"
      "about_x = \"free\"\nabout_y = \"free\"\nabout_z = {{ {} }}\n{}",
      end, about_z, more);
}
std::string torque(const std::string& elements, double moment, const std::string& more = "") {
  return fmt::format("[[load]]\nkind = \"torque\"\nelements = {}\ntorque_nN_nm = [0, 0, {}]\n{}", elements, moment,
                     more);
}
const std::string twist = "[twist]\nmoment_nN_nm = 32\nhold_ps = 100\nrate_nN_nm_per_ps = ";

std::map<std::string, std::string> ramped(double sign = 1) {
  const auto at = [](double moment) { return fmt::format("torque_nN_nm = {}, rate_nN_nm_per_ps = 0.64", moment); };
  const auto points = [](double moment) {
    return fmt::format("torque_nN_nm = [[0, 0], [20, {}], [50, {}], [150, {}]]", 0.4 * moment, moment, moment);
  };
  const double m = 32 * sign;
  std::string by_tube;
  for (int t = 0; t < 19; ++t) by_tube += grip("both", at(m), fmt::format("tubes = [{}]\n", t));
  return {{"twist", twist + "0.64\n" + (sign < 0 ? "hand = \"left\"\n" : "")},
          {"two grips", grip("upper", at(m)) + grip("lower", at(-m))},
          {"a grip at both ends", grip("both", at(m))},
          {"a grip of points in two pieces", grip("both", points(m))},
          {"a grip for each tube", by_tube},
          {"two grips of half the couple",
           grip("both", "torque_nN_nm = [[0, 0], [50, " + std::to_string(m) + "]]", "tubes = [0, 1, 2]\n") +
               grip("both", at(m), "tubes = [3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18]\n")}};
}

std::map<std::string, std::string> sudden() {
  return {{"twist", twist + "0\n"},
          {"two grips", grip("upper", "torque_nN_nm = 32") + grip("lower", "torque_nN_nm = -32")},
          {"a grip at both ends", grip("both", "torque_nN_nm = 32")},
          {"two loads", torque("[-1]", 32) + torque("[0]", -32)},
          {"a load on opposite ends", torque("\"opposite-ends\"", 32)},
          {"loads that add up", torque("\"opposite-ends\"", 12) + torque("\"opposite-ends\"", 20)},
          {"loads for some tubes each", torque("\"opposite-ends\"", 32, "tubes = [0, 5, 7]\n") +
                                            torque("\"opposite-ends\"", 32,
                                                   "tubes = [1, 2, 3, 4, 6, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, "
                                                   "18]\n")}};
}

struct Rope {
  Scene scene;
  Prepared p;

  explicit Rope(const std::string& ends, double length = 163, const std::string& more = "")
      : scene(scene_of_text(
            fmt::format("format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-paper\"\n[rope]\ntubes = "
                        "19\nlength_nm = {}\n{}{}[run]\nduration_ps = 150\n",
                        length, more, ends),
            "rope.toml")),
        p(prepare(scene)) {}
  EndDrives drives() const { return end_drives(p.loads, p.topology); }
};

std::vector<std::string> notes(const Rope& rope) {
  std::vector<std::string> all = limits_ahead(rope.scene, rope.p);
  all.push_back(helix_ahead(rope.scene, rope.p).value_or(""));
  if (const auto turn = quasi_static(rope.scene, rope.p)) all.push_back(words_of(*turn));
  return all;
}

void expect_alike(const std::map<std::string, std::string>& ways) {
  const Rope first(ways.at("twist"));
  const EndMoment moment = end_moment(first.drives()).value();
  const RestTheory rest = rest_theory(first.scene, first.p);
  const SceneFeatures f = features_of(first.scene, first.p);
  for (const auto& [name, ends] : ways) {
    SCOPED_TRACE(name);
    const Rope rope(ends);
    EXPECT_EQ(notes(rope), notes(first));
    EXPECT_NEAR(expected_shock(rope.scene, rope.p), expected_shock(first.scene, first.p), 1e-12);
    EXPECT_NEAR(twist_energy_of(rope.scene, rope.p.topology, rope.p.loads),
                twist_energy_of(first.scene, first.p.topology, first.p.loads), 1e-9);
    const SceneFeatures own = features_of(rope.scene, rope.p);
    EXPECT_NEAR(own.turn, f.turn, 1e-12);
    EXPECT_NEAR(own.curvature, f.curvature, 1e-12);
    EXPECT_EQ(own.sudden, f.sudden);
    EXPECT_NEAR(own.ramp(), f.ramp(), 1e-9);
    const RestTheory own_rest = rest_theory(rope.scene, rope.p);
    EXPECT_NEAR(own_rest.compact, rest.compact, 1e-12);
    EXPECT_NEAR(own_rest.open, rest.open, 1e-12);
    for (const double time : {0.0, 10.0, 30.0, 49.0, 51.0, 140.0})
      EXPECT_NEAR(moment_at(rope.drives(), time), moment_at(first.drives(), time), 1e-9) << time;
    EXPECT_TRUE(end_moment(rope.drives())->twists());
    EXPECT_NEAR(whole_from(rope.drives()), whole_from(first.drives()), 1e-9);
    EXPECT_NEAR(end_moment(rope.drives())->rate(), moment.rate(), 1e-9);
  }
}

TEST(EndDrives, ARampIsTheSameInAllWays) {
  expect_alike(ramped());
  const std::vector<std::string> words = notes(Rope(ramped().at("a grip at both ends")));
  EXPECT_THAT(words, Contains(HasSubstr("wall_twist to 0.0681, from about 28.6 ps on, beyond its limit")));
  EXPECT_THAT(words, Contains(HasSubstr("bring shock")));
  EXPECT_THAT(words, Contains(HasSubstr("becomes a helix")));
}

TEST(EndDrives, ALeftHandedRampToo) { expect_alike(ramped(-1)); }

TEST(EndDrives, AMomentThatActsAtOnceIsTheSameInAllWays) { expect_alike(sudden()); }

TEST(EndDrives, TheLogHasTheMomentInAllWays) {
  const auto logged = [](const std::string& ends) {
    MovingScene moving(Rope(ends, 8.136).scene);
    moving.simulation.steps(20);
    LogRow row = moving.row();
    return row["moment_nN_nm"];
  };
  for (const auto& [name, ends] : sudden()) EXPECT_NEAR(logged(ends), 32, 1e-12) << name;
  const auto ways = ramped(-1);
  const double moment = logged(ways.at("twist"));
  EXPECT_LT(moment, 0);
  for (const char* name : {"two grips", "a grip at both ends", "a grip of points in two pieces"})
    EXPECT_NEAR(logged(ways.at(name)), moment, 1e-9) << name;
}

// A clamp with rounded corners has the moment that it applies.
TEST(EndDrives, TheLogHasTheMomentWithItsRoundedCorners) {
  const Rope sharp(grip("both", "torque_nN_nm = 32, rate_nN_nm_per_ps = 0.64"));
  std::string rounded_text = grip("both", "torque_nN_nm = 32, rate_nN_nm_per_ps = 0.64");
  rounded_text.replace(rounded_text.find("smooth_ps = 0"), 13, "smooth_ps = 9");
  const Rope rounded(rounded_text);
  EXPECT_NEAR(moment_at(rounded.drives(), 25), moment_at(sharp.drives(), 25), 1e-9);
  EXPECT_LT(moment_at(rounded.drives(), 4), 0.7 * moment_at(sharp.drives(), 4));
  EXPECT_EQ(notes(rounded), notes(sharp));
}

// --- Thresholds ---

// Without its runs.
PhasePoint searched(const std::string& key, const std::string& ends) {
  const std::filesystem::path dir =
      std::filesystem::temp_directory_path() / ("ropewalk-end-drives-" + std::to_string(getpid()));
  std::filesystem::create_directories(dir);
  std::ofstream(dir / "rope.toml")
      << "format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-paper\"\n[rope]\ntubes = "
         "19\nlength_nm = 81.36\n[start]\nwave_nm = 0.02\n[run]\nduration_ps = 150\n"
      << ends;
  const Sweep sweep = sweep_of_text(
      fmt::format(
          "format = \"ropewalk-sweep-1\"\nscene = \"rope.toml\"\n[threshold]\nkey = \"{}\"\nfrom = 20\nto = "
          "60\ncolumn = \"amplitude_nm\"\nabove = 1\n",
          key),
      (dir / "s.toml").string());
  std::filesystem::remove_all(dir);
  return point_in_theory(sweep, points_of(sweep).front());
}

TEST(EndDrives, AnyKeyOfBothEndsHasTheTheoryOfItsThreshold) {
  const PhasePoint by_twist = searched("twist.moment_nN_nm", ramped().at("twist"));
  ASSERT_TRUE(by_twist.theory);
  const std::map<std::string, std::string> ways = {
      {"grip.0.about_z.torque_nN_nm", ramped().at("a grip at both ends")},
      {"load.0.torque_nN_nm.2", sudden().at("a load on opposite ends")}};
  for (const auto& [key, ends] : ways) {
    const PhasePoint other = searched(key, ends);
    ASSERT_TRUE(other.theory) << key;
    EXPECT_NEAR(other.static_theory(), by_twist.static_theory(), 1e-9) << key;
  }
  const PhasePoint by_grip = searched("grip.0.about_z.torque_nN_nm", ramped().at("a grip at both ends"));
  EXPECT_NEAR(by_grip.kinetic_theory(), by_twist.kinetic_theory(), 1e-6);
  EXPECT_FALSE(searched("grip.0.about_z.torque_nN_nm", ramped().at("two grips")).theory) << "one end alone";
  EXPECT_FALSE(searched("rope.tubes", ramped().at("twist")).theory);
}

// --- Who is asked what ---

TEST(EndDrives, TheoryAsksForOppositeCouplesOnFreeEnds) {
  const auto rests = [](const std::string& ends) {
    const Rope rope(ends, 40);
    const bool helix = helix_theory(rope.scene, rope.p).has_value();
    try {
      rest_theory(rope.scene, rope.p);
      return helix;
    } catch (const InputError&) {
      EXPECT_FALSE(helix) << ends;
      return false;
    }
  };
  EXPECT_TRUE(rests(sudden().at("two loads")));
  EXPECT_FALSE(rests(torque("[-1]", 32) + torque("[0]", -31))) << "no equilibrium";
  EXPECT_FALSE(rests(torque("\"ends\"", 32))) << "the rope turns as a whole";
  EXPECT_FALSE(rests(torque("\"opposite-ends\"", 32, "tubes = [0, 1]\n"))) << "on two tubes";
  EXPECT_FALSE(rests(torque("[5]", 32) + torque("[0]", -32))) << "on no end";
  EXPECT_FALSE(rests(torque("[-1]", 32) + "[[load]]\nkind = \"fix\"\nelements = [0]\n")) << "one end is held";
  EXPECT_FALSE(rests(torque("\"opposite-ends\"", 32) + "[[load]]\nkind = \"fix\"\nelements = [0]\n"))
      << "a clamp bears it";
  std::string stiff = grip("both", "torque_nN_nm = 32");
  stiff.replace(stiff.find("about_x = \"free\""), 16, "about_x = \"held\"");
  EXPECT_FALSE(rests(stiff)) << "tubes may not tilt";
  std::string disc = grip("both", "torque_nN_nm = 32");
  disc.replace(disc.find("\"each\""), 6, "\"disc\"");
  EXPECT_FALSE(rests(disc)) << "no couple on each tube";
}

// The middle of a rope that is driven at both ends stays, and the other end of one that is driven at one end.
TEST(EndDrives, ARopeThatOneEndDrivesAgainstAClampHasTheForecastOfThatMoment) {
  const std::string below = "[[grip]]\nend = \"lower\"\n";
  const Rope both(ramped().at("a grip at both ends")),
      one(grip("upper", "torque_nN_nm = 32, rate_nN_nm_per_ps = 0.64") + below);
  EXPECT_NEAR(expected_shock(one.scene, one.p), 4 * expected_shock(both.scene, both.p), 1e-9);
  EXPECT_EQ(features_of(one.scene, one.p).twist, features_of(both.scene, both.p).twist);
  EXPECT_NEAR(moment_at(one.drives(), 25), moment_at(both.drives(), 25), 1e-9);
  const Rope lower(grip("lower", "torque_nN_nm = -32, rate_nN_nm_per_ps = 0.64") + "[[grip]]\nend = \"upper\"\n");
  EXPECT_NEAR(moment_at(lower.drives(), 25), moment_at(both.drives(), 25), 1e-9);
  EXPECT_EQ(notes(lower), notes(one));
}

TEST(EndDrives, AMomentInTotalIsThatOfADisc) {
  const Rope total(twist + "12.16\nreading = \"total\"\n" + "application = \"tangential\"\n");
  std::string disc = grip("both", "torque_nN_nm = 32, rate_nN_nm_per_ps = 12.16");
  disc.replace(disc.find("\"each\""), 6, "\"disc\"");
  const Rope by_disc(disc);
  EXPECT_EQ(end_moment(total.drives())->of_each(19), end_moment(by_disc.drives())->of_each(19));
  EXPECT_NEAR(features_of(total.scene, total.p).twist, features_of(by_disc.scene, by_disc.p).twist, 1e-12);
  EXPECT_NEAR(expected_shock(total.scene, total.p), expected_shock(by_disc.scene, by_disc.p), 1e-12);
}

// A couple that a bond does not bear is refused, whoever applies it.
TEST(EndDrives, AMomentThatNoBondBearsIsRefusedInAllWays) {
  for (const std::string& ends :
       {std::string("[twist]\nmoment_nN_nm = 9000\nrate_nN_nm_per_ps = 900\n"),
        grip("both", "torque_nN_nm = 9000, rate_nN_nm_per_ps = 900"), torque("\"opposite-ends\"", 9000)})
    try {
      Rope(ends, 8.136);
      FAIL() << ends;
    } catch (const InputError& e) {
      EXPECT_THAT(e.what(), HasSubstr("9000 nN nm are more than a bond of 1.356 nm bears"));
    }
}

// --- Tension, displacement, rotation ---

std::string clamp(const std::string& end, const std::string& keys) {
  return fmt::format("[[grip]]\nend = \"{}\"\nsmooth_ps = 0\n{}\n", end, keys);
}

void expect_same_demands(const std::vector<std::string>& ways) {
  const Rope first(ways.front(), 40);
  const SceneFeatures f = features_of(first.scene, first.p);
  for (const std::string& ends : ways) {
    SCOPED_TRACE(ends);
    const Rope rope(ends, 40);
    const SceneFeatures own = features_of(rope.scene, rope.p);
    EXPECT_NEAR(own.strain, f.strain, 1e-12);
    EXPECT_NEAR(own.curvature, f.curvature, 1e-12);
    EXPECT_NEAR(own.twist, f.twist, 1e-12);
    EXPECT_EQ(own.sudden, f.sudden);
    EXPECT_EQ(notes(rope), notes(first));
  }
}

TEST(EndDrives, ATensionIsTheSameByGripsAndByLoads) {
  std::string each = grip("both", "torque_nN_nm = 0, rate_nN_nm_per_ps = 1");
  each.replace(each.find("z = \"free\""), 10, "z = { force_nN = 120 }");
  each = each.substr(0, each.find("about_z")) + "about_z = \"free\"\n";
  expect_same_demands({"[[load]]\nkind = \"force\"\nelements = \"opposite-ends\"\nforce_nN = [0, 0, 120]\n",
                       "[[load]]\nkind = \"force\"\nelements = [-1]\nforce_nN = [0, 0, 120]\n"
                       "[[load]]\nkind = \"force\"\nelements = [0]\nforce_nN = [0, 0, -120]\n",
                       each});
  const Rope rope(each, 40);
  EXPECT_THAT(notes(rope), Contains(HasSubstr("bring strain")));
}

TEST(EndDrives, APullIsTheSameAtOneEndAndAtBoth) {
  expect_same_demands({clamp("upper", "z = { displacement_nm = 4, rate_nm_per_ps = 0.2 }") + clamp("lower", ""),
                       clamp("both", "z = { displacement_nm = 2, rate_nm_per_ps = 0.1 }"),
                       clamp("upper", "z = { displacement_nm = [[0, 0], [20, 4]] }") + clamp("lower", "")});
  const double strain = 0.03;
  expect_same_demands(
      {clamp("upper", fmt::format("z = {{ strain = {}, rate_per_ps = 0.002 }}", strain)) + clamp("lower", ""),
       clamp("both", fmt::format("z = {{ strain = {}, rate_per_ps = 0.002 }}", strain))});
}

TEST(EndDrives, ARotationIsTheSameAtOneEndAndAtBoth) {
  const std::string disc_below = clamp("lower", "");
  expect_same_demands(
      {clamp("upper", "about_z = { rotation_deg = 90, rate_deg_per_ps = 2 }") + disc_below,
       clamp("upper", "about_z = { rotation_turns = 0.25, rate_turns_per_ps = 0.005555555555555556 }") + disc_below,
       clamp("upper", "about_z = { rotation_deg = [[0, 0], [45, 90]] }") + disc_below,
       clamp("upper", "about_z = { rotation_deg = [[0, 0], [45, -90]] }") + disc_below,
       clamp("both", "about_z = { rotation_deg = 45, rate_deg_per_ps = 1 }"),
       clamp("upper", "about_z = { rotation_deg = 60, rate_deg_per_ps = 1.333333333333333 }") +
           clamp("lower", "about_z = { rotation_deg = -30, rate_deg_per_ps = 0.6666666666666666 }"),
       "[[load]]\nkind = \"rotate\"\nelements = [-1]\nrate_deg_per_ps = 2\nangle_deg = 90\naxial_free = false\n"
       "[[load]]\nkind = \"fix\"\nelements = [0]\n"});
  const Rope as_one(clamp("upper", "about_z = { rotation_deg = 90, rate_deg_per_ps = 2 }") +
                        clamp("lower", "about_z = { rotation_deg = 90, rate_deg_per_ps = 2 }"),
                    40);
  EXPECT_FALSE(quasi_static(as_one.scene, as_one.p)) << "both ends turn alike";
  EXPECT_NEAR(features_of(as_one.scene, as_one.p).twist, 0, 1e-12);
}

// --- A grip at both ends ---

TEST(EndDrives, AGripAtBothEndsIsTwoOppositeGrips) {
  const std::string pull = "z = { force_nN = [[0, 0], [10, 3]] }\nabout_x = { rotation_deg = [[0, 0], [10, 5]] }";
  const std::string push = "z = { force_nN = [[0, 0], [10, -3]] }\nabout_x = { rotation_deg = [[0, 0], [10, -5]] }";
  MovingScene one(Rope(clamp("both", pull), 8.136).scene),
      two(Rope(clamp("upper", pull) + clamp("lower", push), 8.136).scene);
  for (MovingScene* m : {&one, &two}) m->simulation.steps(50);
  for (std::size_t i = 0; i < one.state().size(); ++i)
    EXPECT_EQ((Vector3(one.state().position[i]) - Vector3(two.state().position[i])).norm(), 0) << i;
}

TEST(EndDrives, ALoadWithoutAnOppositeDoesNotGoOnOppositeEnds) {
  EXPECT_THROW(Rope("[[load]]\nkind = \"fix\"\nelements = \"opposite-ends\"\n", 8.136), InputError);
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
