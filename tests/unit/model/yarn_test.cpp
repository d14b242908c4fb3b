#include "model/yarn.hpp"

#include <gtest/gtest.h>

namespace ropewalk {
namespace {
namespace UNIT {

// A yarn of 20 um with 2000 turns per metre.
TEST(Yarn, TurnsAndAngleAreOneAnothersInverse) {
  EXPECT_NEAR(yarn_turns(7.16245 * units::degree, 20e3), 2000e-9, 1e-11);
  EXPECT_NEAR(std::atan(yarn_slope(2000e-9, 20e3)) / units::degree, 7.16245, 1e-5);
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
