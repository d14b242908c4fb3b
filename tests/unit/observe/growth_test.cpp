// Growth rates, thresholds and power laws against data made up for them.
#include "observe/growth.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "campaign/threshold.hpp"
#include "io/log.hpp"
#include "run/stop_watch.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

TEST(Growth, RateAndItsErrorOfNoisyGrowth) {
  std::vector<double> t, y;
  unsigned state = 1;
  for (int k = 0; k < 200; ++k) {
    state = state * 1664525u + 1013904223u;
    t.push_back(0.5 * k);
    y.push_back(0.03 * std::exp(0.021 * t.back()) * (1 + 0.1 * (state / 4294967296.0 - 0.5)));
  }
  const Growth g = growth_of(t, y);
  EXPECT_NEAR(g.rate, 0.021, 4 * g.error);
  // Even noise of the width 0.1: 0.029/sqrt(200)/28.9 ps.
  EXPECT_NEAR(g.error, 7e-5, 2e-5);
  EXPECT_TRUE(std::isinf(growth_of({0, 1, 2}, {1, 2, 4}).error));
  EXPECT_NEAR(growth_of({0, 1, 2}, {1, -2, 4}).rate, std::log(2), 1e-12) << "what is not positive is left out";
}

TEST(Growth, OscillationAboutGrowthCountsAsFewValues) {
  std::vector<double> t, y;
  for (int k = 0; k < 200; ++k) {
    t.push_back(k);
    y.push_back(std::exp(0.01 * k + 0.2 * std::sin(0.1 * k)));
  }
  const Growth g = growth_of(t, y);
  EXPECT_NEAR(g.rate, 0.01, 3 * g.error);
  EXPECT_GT(g.error, 2e-4);  // 1.7e-4 if all rows were independent
}

TEST(Threshold, PowerLawWithItsError) {
  const auto law = power_law({1, 2, 4, 8}, {10, 5, 2.5, 1.25});
  ASSERT_TRUE(law);
  EXPECT_NEAR(law->exponent, -1, 1e-12);
  EXPECT_NEAR(law->error, 0, 1e-12);
  const auto noisy = power_law({1, 2, 4}, {1, 2.2, 4});
  EXPECT_NEAR(noisy->error, std::log(1.1) * std::sqrt(2.0 / 3) / std::log(2.0) / std::sqrt(2.0), 1e-6);
}

LogRow row(double time, double amplitude) {
  LogRow r;
  r["time_ps"] = time;
  r["step"] = 10 * time;
  r["amplitude_nm"] = amplitude;
  return r;
}

TEST(Trial, GrowthIsThatUnderTheWholeLoadAndClearOfTheStart) {
  std::vector<LogRow> log;
  for (int k = 0; k <= 100; ++k) log.push_back(row(k, k < 20 ? 0.02 : 0.02 * std::exp(0.05 * (k - 20))));
  ThresholdQuestion q{"twist.moment_nN_nm"};
  const Trial t = trial_of(log, q, 30, 0.02, 10, true);
  EXPECT_TRUE(t.passed);
  EXPECT_EQ(t.time, 99);  // 0.02 exp(0.05 x 79) = 1.04
  ASSERT_TRUE(t.rate);
  EXPECT_NEAR(*t.rate, 0.05, 1e-9);
  EXPECT_FALSE(trial_of(log, q, 30, 0.02, 97, true).rate) << "too few rows under the whole load";
  EXPECT_FALSE(t.cut_short);
  for (const bool by_a_rule : {false, true}) {
    const Trial none = trial_of({log.begin(), log.begin() + 50}, q, 30, 0.02, 10, by_a_rule);
    EXPECT_FALSE(none.passed);
    EXPECT_EQ(none.cut_short, by_a_rule);
    EXPECT_EQ(none.time, by_a_rule ? log[49]["time_ps"] : 0);
  }
}

// A rope whose centre line leaves its chord by `amplitude` in all of its length, or at its open ends alone.
LogRow rope_row(double time, double amplitude, bool open_ends) {
  LogRow r = row(time, amplitude);
  r["radius_mid_nm"] = 4.14;
  r["radius_end_nm"] = open_ends ? 20 : 4.14;
  r["middle_amplitude_nm"] = open_ends ? 0.1 : amplitude;
  r["geometric_twist_deg"] = time < 20 ? 100 : 720;
  return r;
}

TEST(Trial, AHelixIsNoBrush) {
  for (const bool open_ends : {false, true}) {
    std::vector<LogRow> log;
    for (int k = 0; k <= 80; ++k) log.push_back(rope_row(k, 0.05 * k, open_ends && k > 30));
    ThresholdQuestion q{"twist.moment_nN_nm"};
    const Trial by_amplitude = trial_of(log, q, 30, 0.02, 20, false);
    EXPECT_TRUE(by_amplitude.passed);
    EXPECT_EQ(by_amplitude.time, 21);
    q.shape = RopeShape::helix;
    const Trial t = trial_of(log, q, 30, 0.02, 20, false);
    EXPECT_EQ(t.passed, !open_ends);
    EXPECT_EQ(t.shape, open_ends ? "brush" : "helix");
    EXPECT_EQ(t.time, open_ends ? 0 : 42);  // half of the radius
    ASSERT_TRUE(t.turn);
    EXPECT_NEAR(*t.turn, 4 * units::pi, 1e-12) << "under the whole load";
  }
}

TEST(StopWatch, KnowsWhenAQuestionIsDecided) {
  StopRule above, steady, growth, limit;
  above.column = steady.column = growth.column = "amplitude_nm";
  above.value = 2;
  steady.when = StopRule::When::steady;
  steady.value = 0.1;
  steady.from = 30;
  growth.when = StopRule::When::growth;
  growth.value = 0.01;
  limit.when = StopRule::When::limit;
  limit.limit = "wall_twist";
  const auto decided_at = [](const StopRule& rule, auto amplitude, const std::vector<LimitRecord>& passed = {}) {
    StopWatch watch({rule});
    for (int k = 0; k < 100; ++k) {
      watch.add(row(k, amplitude(k)));
      if (!watch.decided(passed).empty()) return k;
    }
    return -1;
  };
  EXPECT_EQ(decided_at(above, [](int k) { return 0.1 * k; }), 21);
  EXPECT_EQ(decided_at(above, [](int) { return 1.0; }), -1);
  EXPECT_EQ(decided_at(steady, [](int k) { return k < 60 ? 1.0 * k : 60.0; }), 80);
  EXPECT_EQ(decided_at(steady, [](int) { return 1.0; }), 50) << "20 ps of rows, from 30 ps on";
  EXPECT_EQ(decided_at(growth, [](int k) { return std::exp(0.1 * k); }), 20);
  LimitRecord r;
  r.key = "wall_twist";
  EXPECT_EQ(decided_at(limit, [](int) { return 1.0; }, {r}), -1);
  r.passed = true;
  EXPECT_EQ(decided_at(limit, [](int) { return 1.0; }, {r}), 0);
  StopWatch watch({above});
  watch.add(row(1, 1));
  watch.add(row(2, 3));
  EXPECT_THAT(watch.decided({}), ::testing::HasSubstr("decided at 2 ps: amplitude_nm is 3, above 2"));
  watch.cut(15);
  EXPECT_EQ(watch.decided({}), "");
  StopRule helix;
  helix.when = StopRule::When::shape;
  StopWatch shapes({helix});
  for (const double amplitude : {0.02, 2.0}) {
    shapes.add(rope_row(0, amplitude, false));
    EXPECT_EQ(shapes.decided({}), "");
  }
  shapes.add(rope_row(3, 2.1, false));
  EXPECT_EQ(shapes.decided({}), "decided at 3 ps: the shape of the rope is helix");
}

Threshold bracket_of(const std::vector<std::pair<double, bool>>& outcomes) {
  std::vector<Trial> trials;
  for (const auto& [value, passed] : outcomes) {
    trials.emplace_back();
    trials.back().value = value;
    trials.back().passed = passed;
  }
  return bracketed(trials, 1, 9);
}

TEST(BracketOfAThreshold, IsTheLowestChangeOfTheOutcome) {
  const Threshold rising = bracket_of({{9, true}, {1, false}, {5, true}, {3, false}});
  EXPECT_FALSE(rising.outside || rising.falling);
  EXPECT_EQ(std::tuple(rising.below, rising.above, rising.changes), std::tuple(3.0, 5.0, 1));
  const Threshold falling = bracket_of({{9, false}, {1, true}, {5, false}, {3, true}});
  EXPECT_FALSE(falling.outside);
  EXPECT_TRUE(falling.falling);
  EXPECT_EQ(std::tuple(falling.below, falling.above, falling.changes), std::tuple(3.0, 5.0, 1));
  const Threshold window = bracket_of({{9, false}, {1, false}, {5, true}});
  EXPECT_EQ(std::tuple(window.below, window.above, window.changes), std::tuple(1.0, 5.0, 2));
  for (const bool passed : {true, false}) {
    const Threshold none = bracket_of({{1, passed}, {9, passed}});
    EXPECT_TRUE(none.outside);
    EXPECT_EQ(std::tuple(none.below, none.above, none.changes), std::tuple(1.0, 9.0, 0));
  }
}

// The seeds with a threshold in the range are not a sample of all.
TEST(ThresholdOfSeeds, IsNoMeanWhereSomeLieOutsideOfTheRange) {
  PhasePoint point;
  point.seeds = {bracket_of({{1, false}, {9, true}, {5, false}}), bracket_of({{1, false}, {9, true}, {5, true}})};
  EXPECT_NEAR(point.by_bisection(), 5, 1e-12);
  EXPECT_EQ(point.remarks(), "");
  EXPECT_TRUE(point.begun());
  EXPECT_FALSE(PhasePoint().begun());
  point.seeds.push_back(bracketed({}, 1, 9));  // has not begun
  EXPECT_NEAR(point.by_bisection(), 5, 1e-12);
  EXPECT_EQ(point.outside_seeds(), 0u);
  point.seeds.back() = bracket_of({{1, false}, {9, false}});
  EXPECT_TRUE(std::isnan(point.by_bisection()) && std::isnan(point.bisection_error()));
  EXPECT_EQ(point.outside_seeds(), 1u);
  EXPECT_THAT(point.remarks(), ::testing::HasSubstr("the same in all of the range with 1 of 3 seeds"));
  point.seeds[0].trials[0].cut_short = true;
  EXPECT_THAT(point.remarks(), ::testing::HasSubstr("1 run was ended by a [[stop]] of the scene"));
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
