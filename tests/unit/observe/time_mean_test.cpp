// Errors of means over time cover the means that they are of.
#include "observe/time_mean.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace ropewalk {
namespace {
namespace UNIT {

// Values whose correlation falls by `alike` from one to the next, with the mean 3 and the variance 4. Their tau is
// (1 + alike)/2 (1 - alike).
std::vector<double> record(std::mt19937& random, std::size_t count, double alike) {
  std::normal_distribution<double> normal;
  std::vector<double> out;
  double now = normal(random);
  for (std::size_t k = 0; k < count; ++k) {
    out.push_back(3 + 2 * now);
    now = alike * now + std::sqrt(1 - alike * alike) * normal(random);
  }
  return out;
}

// 300 records: the true mean lies within one error in 68.3 % of them, within two binomial standard errors, 5.4 %.
TEST(TimeMean, LiesWithinItsErrorAsOftenAsItShould) {
  std::mt19937 random(1);
  for (const double alike : {0.0, 0.5, 0.9, -0.3}) {
    int within = 0;
    double rows = 0;
    for (int k = 0; k < 300; ++k) {
      const TimeMean m = time_mean(record(random, 2000, alike));
      within += std::fabs(m.mean - 3) < m.error;
      rows += m.rows / 300;
    }
    EXPECT_NEAR(within / 300.0, 0.683, 0.054) << alike;
    if (alike >= 0) {
      EXPECT_NEAR(rows, 0.5 * (1 + alike) / (1 - alike), 0.05 * rows) << alike;
    }
  }
}

// A record that drifts, or that is no
// longer than its memory, says nothing. By chance some of these look longer.
TEST(TimeMean, HasNoErrorWhereTheRecordIsTooShort) {
  std::mt19937 random(2);
  int with_error = 0;
  for (int k = 0; k < 200; ++k) {
    const TimeMean few = time_mean(record(random, 100, 0.9));
    with_error += std::isfinite(few.error);
    if (!std::isfinite(few.error)) {
      EXPECT_GT(few.rows_needed, 100);
    }
  }
  EXPECT_LT(with_error, 10);
  std::vector<double> drift, wave;
  for (int k = 0; k < 400; ++k) drift.push_back(0.01 * k), wave.push_back(std::sin(0.3 * k));
  EXPECT_TRUE(std::isnan(time_mean(drift).error));
  EXPECT_LT(time_mean(wave).error, 0.06);
  EXPECT_TRUE(std::isnan(time_mean({1}).error));
  EXPECT_TRUE(std::isnan(time_mean({}).mean));
  EXPECT_EQ(time_mean({2, 2, 2}).error, 0);
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
