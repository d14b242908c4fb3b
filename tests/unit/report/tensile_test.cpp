// What a testing machine tells, from logs whose numbers are known.
#include "report/tensile.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace ropewalk {
namespace {
namespace UNIT {

using testing::HasSubstr;

struct Point {
  double strain, stress;
};

std::vector<LogRow> log_of(const std::vector<Point>& points) {
  std::vector<LogRow> log(points.size());
  for (std::size_t k = 0; k < points.size(); ++k) {
    log[k]["time_ps"] = static_cast<double>(k);
    log[k]["ends_strain"] = points[k].strain;
    log[k]["stress_GPa"] = points[k].stress;
    log[k]["specific_stress_N_per_tex"] = 0.5 * points[k].stress;
    log[k]["beta_deg"] = 10 + static_cast<double>(k);
    log[k]["links_formed"] = 40;
    log[k]["links_broken"] = k + 1 == points.size() ? 6 : 0;
  }
  return log;
}

// 300 GPa up to 3 GPa, then straight down by as much.
const std::vector<Point> pull = {{0, 0},         {0.0025, 0.75}, {0.005, 1.5},   {0.0075, 2.25}, {0.01, 3},
                                 {0.0125, 2.25}, {0.015, 1.5},   {0.0175, 0.75}, {0.02, 0}};

TEST(Tensile, NumbersOfAPull) {
  const TensileTest t = tensile_test(log_of(pull), {9, 1, 3, 5, 7});
  EXPECT_DOUBLE_EQ(t.strength, 3);
  EXPECT_DOUBLE_EQ(t.specific, 1.5);
  EXPECT_DOUBLE_EQ(t.strain, 0.01);
  EXPECT_NEAR(t.modulus, 300, 1e-9);
  // The triangle up to the peak and a trapezoid behind it, until the first row below half.
  EXPECT_NEAR(t.toughness, 1e3 * (0.5 * 0.01 * 3 + 0.0075 * 0.5 * (3 + 0.75)), 1e-9);
  EXPECT_NEAR(t.specific_toughness, 0.5 * t.toughness, 1e-12);
  EXPECT_TRUE(t.to_half);
  EXPECT_DOUBLE_EQ(t.links, 40);
  EXPECT_DOUBLE_EQ(t.links_broken, 6);
  EXPECT_DOUBLE_EQ(t.breaks_at, 5);
  EXPECT_DOUBLE_EQ(t.breaks_within, 4);
  EXPECT_DOUBLE_EQ(t.before["beta_deg"], 10);
}

// A yarn that grew shorter and longer while it was twisted at free length: what came before the pull has no part.
TEST(Tensile, BeginsWhereTheLastPullBegins) {
  std::vector<Point> points = {{0, 0}, {-0.01, 0.05}, {-0.004, -0.05}, {-0.002, 0.02}, {-0.0021, 0.01}};
  for (const Point& p : pull) points.push_back({p.strain - 0.002, p.stress});
  const TensileTest t = tensile_test(log_of(points), {});
  EXPECT_DOUBLE_EQ(t.before["beta_deg"], 14);
  EXPECT_NEAR(t.strain, 0.0101, 1e-12);
  EXPECT_NEAR(t.modulus, 300, 5);
  EXPECT_TRUE(std::isnan(t.breaks_at)) << "nothing broke";
}

// A slice that crept longer by itself, and whose stress rang when its strain was led, has no strength.
TEST(Tensile, ARopeThatWasNotAtRestHasNoStrength) {
  const std::vector<Point> rings = {{0, 0},       {0.03, 0.02},   {0.08, -0.02}, {0.14, 0.02},
                                    {0.144, 0.4}, {0.145, -0.52}, {0.148, 0.78}, {0.152, 0.1}},
                           falls = {{0, 0}, {0.01, -0.6}, {0.02, 0.7}, {0.021, 1}, {0.03, 0.1}},
                           creeps = {{0, 0}, {0.1, 0.01}, {0.2, 0}, {0.203, 0.5}, {0.206, 1}, {0.21, 0.2}};
  std::vector<std::string> reasons;
  for (const auto& points : {rings, falls, creeps}) {
    const TensileTest t = tensile_test(log_of(points), {});
    EXPECT_FALSE(t.no_strength.empty());
    for (const double value : {t.strength, t.specific, t.strain, t.modulus, t.toughness, t.specific_toughness})
      EXPECT_TRUE(std::isnan(value)) << value;
    EXPECT_FALSE(t.to_half);
    reasons.push_back(t.no_strength);
  }
  EXPECT_THAT(reasons[1], HasSubstr("its stress fell to -0.6 GPa after the pull began"));
  EXPECT_THAT(reasons[2], HasSubstr("it grew longer by 0.203 of its length before it bore a tenth of that"));
  LoadTestKind kind = tensile_kind();
  kind.left_out = "2 of 5 runs failed";
  TensileTest wound = tensile_test(log_of(pull), {});
  wound.before["beta_deg"] = 5;
  const std::vector<LoadTestGroup> groups = {{"a", "", {load_test(tensile_test(log_of(pull), {}))}},
                                             {"b", "", {load_test(wound)}},
                                             {"c", "", {load_test(tensile_test(log_of(creeps), {}))}}};
  const std::string csv = load_tests_csv(kind, groups, "beta_deg");
  EXPECT_THAT(csv, HasSubstr(",why_none\n"));
  EXPECT_THAT(csv, HasSubstr("\"c\",1,0,10,nan,nan,"));
  EXPECT_THAT(csv, HasSubstr("\"" + reasons[2] + "\"\n"));
  EXPECT_THAT(load_tests_svg(kind, groups, "beta_deg"),
              HasSubstr("1 of 3 points without strength are left out; 2 of 5 runs failed"));
  Figures figures;
  const std::string part = load_tests_part(kind, groups, "beta_deg", "", figures);
  EXPECT_THAT(part, HasSubstr("Of c there is no strength: " + reasons[2]));
  EXPECT_THAT(part, HasSubstr("Left out: 2 of 5 runs failed."));
}

// Twisted between clamps that hold its length, a rope is under tension before it is pulled.
TEST(Tensile, BeginsWhereAHeldRopeIsDrawnOut) {
  std::vector<Point> points = {{0, 0}, {0, 0.5}, {0, 1}, {0, 1}};
  for (const Point& p : pull)
    if (p.strain > 0) points.push_back({p.strain, 1 + p.stress});
  const TensileTest t = tensile_test(log_of(points), {});
  EXPECT_DOUBLE_EQ(t.before["beta_deg"], 13);
  EXPECT_NEAR(t.modulus, 300, 1e-9);
  EXPECT_DOUBLE_EQ(t.strength, 4);
  EXPECT_TRUE(t.to_half);
}

// A yarn of 20 um with 2000 turns per metre has a surface at atan(0.04 pi) to its axis: 7.162 degrees.
TEST(Tensile, TurnsPerMetreStandBesideTheAngle) {
  std::vector<LogRow> log = log_of(pull);
  for (LogRow& row : log) row["beta_deg"] = 7.16245;
  const std::vector<LoadTestGroup> groups = {{"a", "", {load_test(tensile_test(log, {}))}}};
  LoadTestKind kind = tensile_kind();
  EXPECT_EQ(load_tests_csv(kind, groups, "beta_deg").find("turns_per_m"), std::string::npos);
  kind.yarn_diameter = 20e3;
  const std::string csv = load_tests_csv(kind, groups, "beta_deg");
  EXPECT_THAT(csv, HasSubstr("to_half,beta_deg,turns_per_m,strength_GPa,"));
  EXPECT_THAT(csv, HasSubstr(",7.16245,2000,3,"));
  Figures figures;
  EXPECT_THAT(load_tests_part(kind, groups, "beta_deg", "", figures),
              HasSubstr("<th>turns per metre of a yarn of 20 µm</th>"));
}

TEST(Tensile, ARunThatEndsEarlyIsSaidToHave) {
  std::vector<Point> part(pull.begin(), pull.begin() + 6);
  EXPECT_FALSE(tensile_test(log_of(part), {}).to_half);
  EXPECT_THROW(tensile_test(log_of({{0, 0}, {0.01, 0}}), {}), std::invalid_argument);
}

TEST(Tensile, TableAndFigureHaveMeansAndErrors) {
  std::vector<Point> stronger = pull;
  for (Point& p : stronger) p.stress *= 1.2;
  const TensileTest a = tensile_test(log_of(pull), {1}), b = tensile_test(log_of(stronger), {3});
  TensileTest wound = a;
  wound.before["beta_deg"] = 25;
  const LoadTestKind& kind = tensile_kind();
  std::vector<LoadTestGroup> groups = {{"l = 20", "20", {load_test(a), load_test(b)}},
                                       {"l = 20, wound", "20", {load_test(wound)}}};
  LimitRecord passed;
  passed.key = "strain", passed.passed = true, passed.passed_at_ps = 7.5;
  groups[0].tests[1].limits = {passed};
  const std::string csv = load_tests_csv(kind, groups, "beta_deg");
  EXPECT_THAT(csv, HasSubstr(",first_limit,first_limit_ps,why_none\n"));
  EXPECT_THAT(csv, HasSubstr(",strain,7.5,\n"));
  EXPECT_THAT(csv, HasSubstr(",,nan,\n"));
  EXPECT_THAT(csv, HasSubstr("run,replicates,to_half,beta_deg,strength_GPa,strength_GPa_standard_error,"));
  EXPECT_THAT(csv, HasSubstr("\"l = 20\",2,2,10,3.3,0.3,1.65,0.15,0.01,0,330,30,"));
  EXPECT_THAT(csv, HasSubstr("\"l = 20, wound\",1,1,25,3,nan,"));
  const std::string svg = load_tests_svg(kind, groups, "beta_deg");
  EXPECT_THAT(svg, HasSubstr("h6M")) << "a tick at each end of the bar";
  EXPECT_THAT(svg, HasSubstr("cos²"));
  EXPECT_THAT(svg, HasSubstr("no bar: one seed"));
  EXPECT_THAT(svg, HasSubstr("y=\"322.0\">0</text>")) << "the axis begins at 0";
  EXPECT_THAT(load_tests_svg(kind, groups, "slip_nm"), testing::IsEmpty()) << "both are at the same place";
  LoadTestKind beside = kind;
  beside.levels = {{1.5, "measured yarn"}};
  EXPECT_THAT(load_tests_svg(beside, groups, "beta_deg"), HasSubstr("measured yarn"));
  Figures figures;
  const std::string part = load_tests_part(kind, groups, "beta_deg", "tube_length_nm", figures);
  EXPECT_THAT(part, HasSubstr("<td>2 of 2</td>"));
  EXPECT_THAT(part, HasSubstr("Lines: tube_length_nm."));
  EXPECT_THAT(part, HasSubstr("3.30 ± 0.30"));
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
