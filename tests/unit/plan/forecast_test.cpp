// How far a prescribed turn is from rest, told before the run.
#include "plan/forecast.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scene/scene_toml.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

using ::testing::HasSubstr;

Scene scene_of(const std::string& rest) {
  return scene_of_text("format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-tersoff\"\n" + rest, "s.toml");
}

const char* const tubes_of_30 = "tube_length_nm = 30\nstagger = \"random\"\n";

QuasiStatic turn_of(const std::string& rest) {
  Scene scene = scene_of(rest);
  return quasi_static(scene, prepare(scene)).value();
}

std::string slice(double length, const std::string& rope, const std::string& twist) {
  return fmt::format(
      "[rope]\ntubes = 19\nlength_nm = {}\n{}[periodic]\ntwist_deg_per_nm = {}\n[run]\nduration_ps = 1\n", length,
      rope, twist);
}

double period_of(const std::string& rope) {
  Scene scene = scene_of(slice(130, rope, "[[0, 0], [100, 1]]"));
  return prepare(scene).topology.groups.period;
}

TEST(QuasiStatic, ASliceIsAsFarFromRestAsARopeOfItsLengthBetweenClamps) {
  const QuasiStatic seen = turn_of(slice(130, "", "[[0, 0], [100, 1]]"));
  const double period = period_of("");
  const QuasiStatic rope = turn_of(
      fmt::format("[rope]\ntubes = 19\nlength_nm = {0}\n[[grip]]\nend = \"lower\"\n[[grip]]\nend = \"upper\"\n"
                  "about_z = {{ rotation_deg = [[0, 0], [100, {0}]] }}\n[run]\nduration_ps = 1\n",
                  period));
  EXPECT_TRUE(seen.slice);
  EXPECT_FALSE(rope.slice);
  EXPECT_NEAR(seen.travel, rope.travel, 0.03 * rope.travel);
  EXPECT_NEAR(seen.time, rope.time, 1e-9);
  EXPECT_NEAR(seen.error, rope.error, 0.05 * rope.error);
  EXPECT_THAT(words_of(seen), HasSubstr("from the ends of the slice to its middle"));
  EXPECT_THAT(words_of(rope), HasSubstr("from end to end"));
}

// The fastest of several ramps counts, and tubes in line count as one.
TEST(QuasiStatic, TheFastestRampCountsAndATubeInLineCountsByItsLength) {
  const QuasiStatic one = turn_of(slice(130, "", "[[0, 0], [100, 1]]")),
                    two = turn_of(slice(130, "", "[[0, 0], [900, 0.5], [950, 1]]")),
                    finite = turn_of(slice(130, tubes_of_30, "[[0, 0], [100, 1]]"));
  EXPECT_NEAR(two.error, one.error, 1e-6 * one.error);
  // A slice of finite tubes has more images, and so a shorter period.
  EXPECT_NEAR(finite.error / finite.travel, one.error / one.travel, 0.02 * one.error / one.travel);
  EXPECT_NEAR(finite.travel / one.travel, period_of(tubes_of_30) / period_of(""), 0.02);
}

TEST(QuasiStatic, IsThatOfTheRopeWhereverItStands) {
  Scene scene = scene_of(
      "[rope]\ntubes = 7\nlength_nm = 20\n[[grip]]\nend = \"lower\"\n[[grip]]\nend = \"upper\"\n"
      "about_z = { rotation_deg = [[0, 0], [20, 20]] }\n[run]\nduration_ps = 1\n");
  Prepared p = prepare(scene);
  const QuasiStatic here = quasi_static(scene, p).value();
  for (std::size_t i = 0; i < p.state.size(); ++i)
    p.state.position.set(i, Vector3(p.state.position[i]) + Vector3(8, -5, 0));
  const QuasiStatic there = quasi_static(scene, p).value();
  EXPECT_NEAR(there.travel, here.travel, 1e-9 * here.travel);
  EXPECT_NEAR(there.error, here.error, 1e-9 * here.error);
  QuasiStatic fast = here;
  fast.time = 0.5 * fast.travel;
  EXPECT_THAT(words_of(fast), HasSubstr("one part turns before another feels it"));
  EXPECT_EQ(words_of(fast).find("%"), std::string::npos);
}

TEST(QuasiStatic, WhatIsTwistedFromTheStartDoesNotTurn) {
  Scene scene = scene_of(slice(130, "", "[[0, 1]]"));
  EXPECT_FALSE(quasi_static(scene, prepare(scene)));
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
