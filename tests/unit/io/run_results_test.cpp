// What came of a run, from logs whose numbers are known.
#include "io/run_results.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace ropewalk {
namespace {
namespace UNIT {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

// Turned by 10 degrees a ps: the torque rises by 100 nN nm a ps up to 400 and then falls.
std::vector<LogRow> twisted(double lower_share) {
  const std::vector<double> torque = {0, 100, 200, 300, 400, 150, 100};
  std::vector<LogRow> log(torque.size());
  for (std::size_t k = 0; k < torque.size(); ++k) {
    log[k]["step"] = 50.0 * static_cast<double>(k);
    log[k]["time_ps"] = static_cast<double>(k);
    log[k]["rotation_deg"] = 10.0 * static_cast<double>(k);
    log[k]["torque_upper_nN_nm"] = torque[k];
    log[k]["torque_lower_nN_nm"] = lower_share * torque[k];
    log[k]["stored_MJ_per_kg"] = 0.1 * static_cast<double>(k);
    log[k]["stress_GPa"] = torque[k] / 100;
  }
  return log;
}

LimitRecord passed(const char* key, double ps, std::int64_t step) {
  LimitRecord r;
  r.key = key, r.limit = 2, r.largest = 7, r.passed = true, r.passed_at_ps = ps, r.passed_at_step = step;
  r.passed_tube = 25, r.passed_element = 44, r.passed_held_by = "the upper clamp";
  return r;
}

TEST(RunResults, OfARopeTwistedToFailure) {
  const RunResults r = run_results(twisted(1), {}, {{4.5, 3, 12}, {4.2, 2, 11, "the upper clamp"}, {5, 3, 17}});
  EXPECT_EQ(r.torque_max, 400);
  EXPECT_EQ(r.torque_max_deg, 40);
  EXPECT_EQ(r.torque_within, 400);
  EXPECT_NEAR(r.first_break_deg, 42, 1e-12) << "between two rows";
  EXPECT_EQ(r.tubes_broken, 2);
  EXPECT_NEAR(r.stored_at_limit, 0.6, 1e-12) << "the largest, where no limit was passed";
  EXPECT_TRUE(std::isnan(r.strength)) << "its ends were not drawn apart";
  EXPECT_THAT(result_sentences(r),
              ElementsAre("Torque passed its maximum, 400 nN nm, at 40°.",
                          "2 tubes broke, the first at 42°: tube 2, element 11, at the upper clamp.",
                          "The rope stored up to 0.6 MJ/kg."));
}

TEST(RunResults, BeyondALimitAreSaidToBe) {
  const std::vector<LimitRecord> limits = {passed("strain", 3.5, 175), passed("wall_twist", 2.6, 130), {}};
  const RunResults r = run_results(twisted(1), limits, {{4.2, 2, 11}});
  EXPECT_EQ(r.first_limit, "wall_twist");
  EXPECT_EQ(r.torque_within, 200);
  EXPECT_NEAR(r.first_limit_deg, 26, 1e-12);
  EXPECT_TRUE(std::isnan(run_results(twisted(1), {passed("strain", 0, 100)}, {}).first_limit_deg))
      << "a relaxation counts steps";
  EXPECT_TRUE(std::isnan(run_results(twisted(1), {}, {}).first_limit_deg));
  EXPECT_NEAR(r.stored_at_limit, 0.2, 1e-12) << "of the last row before";
  EXPECT_THAT(
      result_sentences(r),
      ElementsAre("Torque passed its maximum, 400 nN nm, at 40°, beyond wall_twist from 2.6 ps on (26°); before, it "
                  "reached 200 nN nm.",
                  "One tube broke at 42°: tube 2, element 11, beyond wall_twist.",
                  "When wall_twist was passed, the rope stored 0.2 MJ/kg."));
  EXPECT_EQ(rows_within(twisted(1), limits), 3u);
  EXPECT_EQ(rows_within(twisted(1), {passed("strain", 3, 150)}), 3u) << "the row at which it is seen is beyond";
  EXPECT_EQ(rows_within(twisted(1), {passed("strain", 0, 100)}), 2u) << "a relaxation counts steps";
  EXPECT_EQ(rows_within(twisted(1), {passed("strain", 0, 0)}), 0u);
  EXPECT_EQ(rows_within(twisted(1), {}), 7u);
  EXPECT_TRUE(std::isnan(run_results(twisted(1), {passed("strain", 0, 0)}, {}).stored_at_limit));
}

TEST(RunResults, KnownErrorsStandInTheSentences) {
  const RunResults r = run_results(twisted(1), {}, {});
  std::vector<double> errors;
  for (const OutputColumn& c : result_columns())
    errors.push_back(std::string(c.name) == "torque_max_nN_nm" ? 12.3 : NAN);
  EXPECT_THAT(result_sentences(r, errors),
              ::testing::Contains("Torque passed its maximum, 400 ± 12 nN nm, at 40°."));
}

TEST(RunResults, TorqueIsThatOfTheHeldEnds) {
  EXPECT_EQ(run_results(twisted(0.5), {}, {}).torque_max, 300) << "the mean of both";
  EXPECT_EQ(run_results(twisted(0), {}, {}).torque_max, 400) << "the lower end is free";
  EXPECT_EQ(run_results(twisted(-1e-5), {}, {}).torque_max, 400);
  std::vector<LogRow> none(3);
  EXPECT_TRUE(std::isnan(run_results(none, {}, {}).torque_max));
  EXPECT_TRUE(result_sentences(run_results({}, {}, {})).empty());
}

TEST(RunResults, StrengthIsThatOfARopeThatIsPulled) {
  std::vector<LogRow> log = twisted(1);
  for (std::size_t k = 0; k < log.size(); ++k) log[k]["ends_strain"] = 0.01 * static_cast<double>(k);
  const RunResults r = run_results(log, {}, {});
  EXPECT_EQ(r.strength, 4);
  EXPECT_THAT(result_sentences(r),
              ::testing::Contains("Stress passed its maximum, 4 GPa (0 N/tex), at a strain of 0.04."));
}

// Strain counts from the beginning of the pull; a rope that was not at rest then has no strength.
TEST(RunResults, StrainIsThatOfThePull) {
  std::vector<LogRow> log(6);
  const double strain[] = {0, -0.004, -0.0045, -0.003, -0.0015, 0.001}, stress[] = {0, 0.05, 0, 0.7, 1.4, 0.2};
  for (std::size_t k = 0; k < log.size(); ++k) log[k]["ends_strain"] = strain[k], log[k]["stress_GPa"] = stress[k];
  EXPECT_NEAR(run_results(log, {}, {}).strength_strain, 0.003, 1e-12);
  log[3]["stress_GPa"] = -0.9;
  const RunResults r = run_results(log, {}, {});
  EXPECT_TRUE(std::isnan(r.strength));
  EXPECT_THAT(result_sentences(r), ::testing::Contains(HasSubstr("Stress came to 1.4 GPa, which is no strength: its")));
}

// A rope that is bent grows shorter, and its clamps bear its cohesion: that is no strength, and noise is no torque.
TEST(RunResults, OfABentRopeIsItsMoment) {
  std::vector<LogRow> log = twisted(1);
  for (std::size_t k = 0; k < log.size(); ++k) {
    const double moment = log[k]["torque_upper_nN_nm"];
    log[k]["torque_upper_x_nN_nm"] = 3 * moment, log[k]["torque_upper_y_nN_nm"] = -4 * moment;
    log[k]["torque_upper_nN_nm"] = log[k]["torque_lower_nN_nm"] = 0.01 * moment;
    log[k]["ends_strain"] = -1e-3 * static_cast<double>(k);
  }
  const RunResults r = run_results(log, {}, {});
  EXPECT_EQ(r.bending_max, 2000);
  EXPECT_THAT(result_sentences(r), ElementsAre("The bending moment passed its maximum, 2000 nN nm, at 4 ps.",
                                               "The rope stored up to 0.6 MJ/kg."));
  EXPECT_TRUE(std::isnan(r.torque_max));
  EXPECT_TRUE(std::isnan(r.strength));
  for (LogRow& row : log) row["torque_upper_nN_nm"] *= 1000, row["torque_lower_nN_nm"] *= 1000;
  EXPECT_TRUE(std::isnan(run_results(log, {}, {}).bending_max)) << "it is twisted more than bent";
  // Drawn out again from where twist had left it, still shorter than at the start.
  for (std::size_t k = 0; k < log.size(); ++k) log[k]["ends_strain"] = -0.05 + 0.01 * static_cast<double>(k);
  EXPECT_EQ(run_results(log, {}, {}).strength, 4);
}

TEST(LimitsInWords, SayWhichWhereAndSinceWhen) {
  const std::vector<LimitRecord> limits = {passed("strain", 3.5, 175), passed("wall_twist", 243.2, 130), {}};
  EXPECT_EQ(beyond_words(limits), "beyond strain from 3.5 ps on");
  EXPECT_EQ(status_words("finished", limits), "finished, beyond strain from 3.5 ps on");
  EXPECT_EQ(status_words("finished", {}), "finished");
  EXPECT_THAT(
      beyond_sentence({limits[1]}),
      ::testing::AllOf(HasSubstr("From 243.2 ps on this run is beyond a limit of its model: wall_twist, passed in "
                                 "tube 25, element 44, at the upper clamp: "),
                       HasSubstr("collapses there.")));
  EXPECT_THAT(beyond_sentence(limits), HasSubstr("Another limit was passed as well."));
  EXPECT_EQ(beyond_sentence({}), "");
  EXPECT_EQ(worst_words(limits), "strain reached 3.5 times its limit");
  EXPECT_EQ(since_words(passed("strain", 0, 120)), "from step 120 on");
  EXPECT_EQ(since_words(passed("strain", 0, 0)), "from the start on");
  EXPECT_EQ(limit_cells(limits), "strain,3.5");
  EXPECT_EQ(limit_cells({}), ",nan");
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
