// The bisection that finds where a method fails.
#include "cases/common/stability_limit.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace ropewalk::validate {
namespace {
namespace UNIT {

TEST(StabilityLimit, IsFoundByBisectionAndNotANumberWhereThereIsNone) {
  const auto beyond_two = [](double x) { return x > 2; };
  EXPECT_NEAR(limit_between(beyond_two, 1, 5, 1e-4), 2, 4e-4);
  EXPECT_TRUE(std::isnan(limit_between(beyond_two, 3, 5)));
  EXPECT_TRUE(std::isnan(limit_between(beyond_two, 0, 1)));
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk::validate
