// Means over runs that differ in their seed.
#include "report/runs_page.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace ropewalk {
namespace {
namespace UNIT {

std::vector<LogRow> log_of(const std::vector<double>& times, double value) {
  std::vector<LogRow> log(times.size());
  for (std::size_t k = 0; k < times.size(); ++k) {
    log[k]["step"] = 100.0 * static_cast<double>(k);
    log[k]["time_ps"] = times[k];
    log[k]["vdw_eV"] = value + static_cast<double>(k);
  }
  return log;
}

TEST(MeansOfRuns, ReachAsFarAsAllHaveRowsAtTheSameTimes) {
  const RunCurve shorter = mean_of("a", {log_of({0, 1, 2, 3}, 0), log_of({0, 1, 2}, 2)});
  ASSERT_EQ(shorter.log.size(), 3u);
  EXPECT_EQ(shorter.log.back()["vdw_eV"], 3);
  EXPECT_NEAR(shorter.error.back()["vdw_eV"], 1, 1e-12);
  EXPECT_EQ(shorter.remark, "means up to 2 ps, as far as all of them have rows at the same times");
  const RunCurve other = mean_of("a", {log_of({0, 1, 2, 3}, 0), log_of({0, 1, 2.5, 3}, 2)});
  EXPECT_EQ(other.log.size(), 2u);
  EXPECT_EQ(mean_of("a", {log_of({0, 1}, 0), log_of({0, 1}, 2)}).remark, "");
}

TEST(MeansOfRuns, OfRelaxationsAreThoseOfTheirEnds) {
  const RunCurve ends = mean_of("a", {log_of({0, 0, 0, 0}, 0), log_of({0, 0}, 4)});
  ASSERT_EQ(ends.log.size(), 1u);
  EXPECT_EQ(ends.log[0]["vdw_eV"], 4);  // of 3 and 5
  EXPECT_NEAR(ends.error[0]["vdw_eV"], 1, 1e-12);
  EXPECT_EQ(ends.remark, "means of the last rows of relaxations");
  EXPECT_EQ(mean_of("a", {log_of({0, 0, 0}, 0)}).log.size(), 3u) << "of one alone every row is drawn";
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
