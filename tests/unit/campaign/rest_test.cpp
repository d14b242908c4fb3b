// The verdict on where a rope rests, from the logs of two runs; and the theory that chooses their starts.
#include "campaign/rest.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "io/log.hpp"
#include "model/error.hpp"
#include "scene/scene_toml.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

using ::testing::HasSubstr;

// A rope that goes exponentially from one twist to another (deg) with a time of 100 ps, for 500 ps.
std::vector<LogRow> log_of(double from, double to, double voids = 0, double time = 100) {
  std::vector<LogRow> log;
  for (int k = 0; k <= 100; ++k) {
    LogRow row;
    const double at = 5.0 * k, twist = to + (from - to) * std::exp(-at / time);
    row["time_ps"] = at;
    row["geometric_twist_deg"] = twist;
    row["beta_deg"] = 0.12 * twist;
    row["Q"] = 1;
    row["radius_mid_nm"] = voids > 0 && k > 0 ? 12 : 8;
    row["radius_end_nm"] = 8;
    row["void_area_nm2"] = voids;
    log.push_back(row);
  }
  return log;
}
std::array<RestSide, 2> sides(const std::vector<LogRow>& below, const std::vector<LogRow>& above) {
  return {rest_side(below, 0.2), rest_side(above, 1.2)};
}

TEST(Rest, IsQuotedWhereBothSidesAgree) {
  const auto both = sides(log_of(15, 65), log_of(100, 65));
  EXPECT_NEAR(both[0].twist, 65, 1);
  EXPECT_GT(both[0].drift, 0);
  EXPECT_LT(both[1].drift, 0);
  const RestVerdict v = rest_verdict(both, 0.02);
  EXPECT_TRUE(v.agree);
  EXPECT_NEAR(v.twist, 65, 0.5);
  EXPECT_NEAR(v.twist_error, 0.5 * std::fabs(both[1].twist - both[0].twist), 1e-12);
  EXPECT_NEAR(v.beta, 0.12 * v.twist, 1e-9);
  EXPECT_THAT(v.words, HasSubstr("Rests compact"));
  const RestVerdict strict = rest_verdict(sides(log_of(15, 60, 0, 30), log_of(100, 65, 0, 30)), 0.02);
  EXPECT_FALSE(strict.agree);
  EXPECT_THAT(strict.words,
              HasSubstr("Both sides stand still compact, at 60 degrees from below and 65 from above"));
}

TEST(Rest, IsNotQuotedOnTheWay) {
  const RestVerdict v = rest_verdict(sides(log_of(15, 65, 0, 1000), log_of(100, 65, 0, 1000)), 0.02);
  EXPECT_FALSE(v.agree);
  EXPECT_TRUE(std::isnan(v.beta));
  EXPECT_THAT(v.words, HasSubstr("Not at rest: in the last 100 ps the rope that began below rose by"));
  EXPECT_THAT(v.words, HasSubstr("hold_ps"));
}

// Two ropes that swing alike.
TEST(Rest, IsNotQuotedWhereBothStillSwing) {
  std::vector<LogRow> log = log_of(65, 65);
  for (LogRow& row : log) row["geometric_twist_deg"] += 5 * std::sin(row["time_ps"] / 10);
  const RestVerdict v = rest_verdict(sides(log, log), 0.02);
  EXPECT_FALSE(v.agree);
  EXPECT_THAT(v.words, HasSubstr("by 10 degrees"));
}

TEST(Rest, TellsTwoStatesApart) {
  const RestVerdict v = rest_verdict(sides(log_of(15, 65), log_of(400, 371, 40)), 0.02);
  EXPECT_FALSE(v.agree);
  EXPECT_THAT(v.words, HasSubstr("More than one state of rest: compact at 64"));
  EXPECT_THAT(v.words, HasSubstr("open (cage)"));
}

// The same twist in two shapes is no agreement either.
TEST(Rest, AsksForTheSameBranch) {
  EXPECT_FALSE(rest_verdict(sides(log_of(15, 65), log_of(100, 65, 40)), 0.02).agree);
}

// 19 and 91 published tubes of 67.8 nm under 35 nN nm come to rest at 228 and 65 degrees over 66.4 nm
// (data/campaigns/rest). A disc of 19 tubes is a rough one.
TEST(RestTheory, IsNearWhereRopesRest) {
  const auto theory = [](int tubes, const std::string& more = "") {
    const Scene scene = scene_of_text(
        "format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-paper\"\n[rope]\ntubes = " +
            std::to_string(tubes) +
            "\nlength_nm = 67.8\n[twist]\nmoment_nN_nm = 35\nrate_nN_nm_per_ps = 1\nhold_ps = 10\n" + more,
        "scene.toml");
    Scene copy = scene;
    const Prepared p = prepare(copy);
    return rest_theory(copy, p);
  };
  EXPECT_NEAR(theory(19).compact * 66.44 / units::degree, 228, 0.22 * 228);
  EXPECT_NEAR(theory(91).compact * 66.44 / units::degree, 65, 0.1 * 65);
  EXPECT_NEAR(theory(91).open * 66.44 / units::degree, 372, 2);
  EXPECT_EQ(theory(91, "hand = \"left\"\n").compact, -theory(91).compact);
  EXPECT_THROW(theory(19, "unload_rate_nN_nm_per_ps = 1\n"), InputError) << "it would rest under no moment";
}

TEST(RestTheory, LeftHandedRopesBeginWoundToTheLeft) {
  const auto sweep = [](const std::string& more) {
    Scene scene = scene_of_text(
        "format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-paper\"\n[rope]\ntubes = 19\n"
        "length_nm = 67.8\n[twist]\nmoment_nN_nm = 35\nrate_nN_nm_per_ps = 1\n" +
            more,
        "scene.toml");
    const Prepared p = prepare(scene);
    return rest_sweep(scene, p, rest_theory(scene, p), -1);
  };
  std::string right = sweep("hold_ps = 9\n");
  const auto at = right.find("= [") + 3, comma = right.find(", ", at) + 2;
  EXPECT_EQ(sweep("hold_ps = 9\nhand = \"left\"\n"), right.insert(comma, "-").insert(at, "-"));
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
