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
  return {rest_side(below, {}, 0.2), rest_side(above, {}, 1.2)};
}

TEST(Rest, IsQuotedWhereBothSidesAgree) {
  const auto both = sides(log_of(15, 65), log_of(100, 65));
  EXPECT_NEAR(both[0].twist, 65, 1);
  EXPECT_GT(both[0].drift, 0);
  EXPECT_LT(both[1].drift, 0);
  const RestVerdict v = rest_verdict(both, 0.02);
  EXPECT_TRUE(v.agree());
  EXPECT_NEAR(v.twist.value, 65, 1e-3) << "the motion that is left is continued";
  EXPECT_NEAR(v.beta.value, 0.12 * v.twist.value, 1e-4);
  EXPECT_THAT(v.words, HasSubstr("Rests compact"));
  const RestVerdict strict = rest_verdict(sides(log_of(15, 60, 0, 30), log_of(100, 65, 0, 30)), 0.02);
  EXPECT_EQ(strict.kind, RestVerdict::Kind::apart);
  EXPECT_THAT(strict.words,
              HasSubstr("Both sides stand still compact, at 60 degrees from below and 65 from above"));
}

// Both creep as an exponential does, which is continued.
TEST(Rest, IsEstimatedOnTheWay) {
  const RestVerdict v = rest_verdict(sides(log_of(55, 65, 0, 300), log_of(100, 65, 0, 300)), 0.02);
  EXPECT_EQ(v.kind, RestVerdict::Kind::creeps);
  EXPECT_NEAR(v.twist.value, 65, 0.01);
  // From 100 the distance is 35 exp(-500/300), and 0.01 of 65 is wanted.
  EXPECT_NEAR(v.further_time, 300 * std::log(35 * std::exp(-500.0 / 300) / 0.65), 3);
  EXPECT_THAT(v.words, HasSubstr("Creeps compact: in the last 100 ps the rope that began below rose by"));
  EXPECT_THAT(v.words, HasSubstr("hold_ps"));
  EXPECT_THAT(v.words, HasSubstr("--viscosity"));
}

// Ways that are no exponential: the two sides go to different twists, or nobody knows where.
TEST(Rest, IsNotQuotedOnTheWay) {
  std::vector<LogRow> steady = log_of(15, 15);
  for (LogRow& row : steady) row["geometric_twist_deg"] += 0.05 * row["time_ps"];
  const RestVerdict v = rest_verdict(sides(steady, log_of(100, 65, 0, 1000)), 0.02);
  EXPECT_EQ(v.kind, RestVerdict::Kind::moves);
  EXPECT_TRUE(std::isnan(v.beta.value));
  EXPECT_THAT(v.words, HasSubstr("Not at rest: in the last 100 ps the rope that began below rose by"));
  std::vector<LogRow> few = log_of(65, 65);
  few.resize(20);
  EXPECT_THAT(rest_verdict(sides(few, few), 0.02).words, HasSubstr("run.log_every_ps"));
}

// Seven published tubes of 30 nm under 25 nN nm rest at 102.31 degrees. At viscosities of 20, 50 and 100 (eV
// ps/nm^3) both starts have passed it and creep down together: geometric_twist_deg of `ropewalk rest`, every 10.3
// ps.
TEST(Rest, OfTwoStartsThatCreepTogetherIsWhereTheyCreepTo) {
  struct Runs {
    double viscosity;
    std::vector<double> below, above;
  };
  const std::vector<Runs> runs = {
      {20,
       {19.994,  105.081, 119.134, 119.536, 118.684, 117.523, 116.380, 115.264, 114.237, 113.323, 112.476,
        111.699, 111.007, 110.363, 109.765, 109.227, 108.729, 108.266, 107.846, 107.458, 107.094, 106.761,
        106.454, 106.166, 105.902, 105.658, 105.429, 105.217, 105.021, 104.838, 104.668, 104.511, 104.363,
        104.226, 104.099, 103.980, 103.869, 103.766, 103.670, 103.580, 103.497},
       {119.057, 133.349, 128.850, 123.112, 120.096, 118.208, 116.876, 115.589, 114.485, 113.574, 112.686,
        111.877, 111.203, 110.533, 109.904, 109.367, 108.857, 108.374, 107.957, 107.563, 107.182, 106.846,
        106.534, 106.235, 105.969, 105.724, 105.486, 105.270, 105.072, 104.883, 104.710, 104.552, 104.401,
        104.260, 104.132, 104.010, 103.896, 103.793, 103.695, 103.603, 103.518}},
      {50,
       {19.994,  108.600, 120.227, 121.003, 121.053, 120.764, 120.325, 119.797, 119.242, 118.691, 118.145,
        117.615, 117.107, 116.615, 116.141, 115.689, 115.253, 114.833, 114.430, 114.042, 113.669, 113.310,
        112.964, 112.631, 112.310, 112.001, 111.702, 111.414, 111.137, 110.868, 110.610, 110.360, 110.118,
        109.885, 109.659, 109.441, 109.231, 109.027, 108.830, 108.639, 108.454},
       {119.057, 152.104, 142.264, 132.312, 126.916, 123.958, 122.228, 121.028, 120.138, 119.425, 118.776,
        118.188, 117.648, 117.123, 116.624, 116.155, 115.699, 115.259, 114.841, 114.438, 114.049, 113.676,
        113.317, 112.971, 112.637, 112.316, 112.006, 111.708, 111.420, 111.142, 110.873, 110.614, 110.364,
        110.123, 109.889, 109.663, 109.445, 109.234, 109.031, 108.833, 108.642}},
      {100,
       {19.994,  106.797, 119.888, 121.529, 122.124, 122.228, 122.097, 121.846, 121.544, 121.224, 120.896,
        120.571, 120.250, 119.934, 119.625, 119.323, 119.027, 118.737, 118.454, 118.177, 117.905, 117.640,
        117.380, 117.125, 116.876, 116.631, 116.392, 116.158, 115.928, 115.703, 115.483, 115.266, 115.055,
        114.847, 114.643, 114.443, 114.247, 114.055, 113.867, 113.682, 113.501},
       {119.057, 147.761, 139.393, 131.064, 127.023, 125.042, 123.975, 123.284, 122.778, 122.358, 121.972,
        121.608, 121.258, 120.918, 120.586, 120.261, 119.945, 119.635, 119.332, 119.036, 118.746, 118.462,
        118.185, 117.913, 117.647, 117.387, 117.132, 116.883, 116.639, 116.399, 116.165, 115.935, 115.710,
        115.489, 115.273, 115.061, 114.853, 114.649, 114.449, 114.253, 114.061}},
  };
  for (const Runs& r : runs) {
    SCOPED_TRACE(r.viscosity);
    const auto log = [&](const std::vector<double>& twists) {
      std::vector<LogRow> rows;
      for (std::size_t k = 0; k < twists.size(); ++k) {
        LogRow row;
        row["time_ps"] = 412.5 * static_cast<double>(k) / static_cast<double>(twists.size() - 1);
        row["geometric_twist_deg"] = twists[k];
        row["beta_deg"] = 0.06 * twists[k];
        row["radius_mid_nm"] = row["radius_end_nm"] = 3;
        rows.push_back(row);
      }
      return rows;
    };
    const RestVerdict v = rest_verdict(sides(log(r.below), log(r.above)), 0.02);
    EXPECT_EQ(v.kind, r.viscosity > 20 ? RestVerdict::Kind::creeps : RestVerdict::Kind::rests) << v.words;
    EXPECT_NEAR(v.twist.value, 102.31, v.twist.error()) << v.words;
    EXPECT_LT(v.twist.error(), 2) << v.words;
    // The two runs agree with each other far better than with the rest: half of their difference is no error.
    EXPECT_GT(std::fabs(0.5 * (r.below.back() + r.above.back()) - 102.31),
              2 * std::fabs(r.below.back() - r.above.back()));
  }
}

// Two ropes that swing alike.
TEST(Rest, IsNotQuotedWhereBothStillSwing) {
  std::vector<LogRow> log = log_of(65, 65);
  for (LogRow& row : log) row["geometric_twist_deg"] += 5 * std::sin(row["time_ps"] / 10);
  const RestVerdict v = rest_verdict(sides(log, log), 0.02);
  EXPECT_EQ(v.kind, RestVerdict::Kind::moves);
  EXPECT_THAT(v.words, HasSubstr("by 10 degrees"));
}

TEST(Rest, TellsTwoStatesApart) {
  const RestVerdict v = rest_verdict(sides(log_of(15, 65, 0, 50), log_of(400, 371, 40, 50)), 0.02);
  EXPECT_EQ(v.kind, RestVerdict::Kind::several);
  EXPECT_THAT(v.words, HasSubstr("More than one state of rest: compact at 65"));
  EXPECT_THAT(v.words, HasSubstr("open (cage)"));
}

// The same twist in two shapes is no agreement either.
TEST(Rest, AsksForTheSameBranch) {
  EXPECT_FALSE(rest_verdict(sides(log_of(15, 65), log_of(100, 65, 40)), 0.02).agree());
}

TEST(Rest, SaysWhichSideIsBeyondALimit) {
  auto both = sides(log_of(15, 65), log_of(100, 65));
  EXPECT_TRUE(beyond_of(both).empty());
  LimitRecord wall;
  wall.key = "wall_twist";
  wall.passed = true;
  wall.passed_at_ps = 243;
  wall.passed_at_step = 5000;
  both[1].limits = {wall};
  ASSERT_EQ(beyond_of(both).size(), 1u);
  EXPECT_THAT(beyond_of(both).front(), HasSubstr("from above is beyond wall_twist from 243 ps on"));
  const std::string table = rest_csv(both);
  EXPECT_THAT(table, HasSubstr(",first_limit,first_limit_ps\nbelow,"));
  EXPECT_THAT(table, HasSubstr(",,nan\nabove,"));
  EXPECT_THAT(table, ::testing::EndsWith(",wall_twist,243\n"));
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
