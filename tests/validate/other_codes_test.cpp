// The contact of other codes that a case compares with has the physics that it stands for.
#include <gtest/gtest.h>

#include <cmath>

#include "cases/common/bead_law.hpp"
#include "cases/common/bundle.hpp"
#include "runner/runner.hpp"
#include "validate/support.hpp"

namespace ropewalk::validate {
namespace {
namespace UNIT {

ParameterSet shipped() { return test::shipped("cnt-10-10-tersoff"); }

// Second neighbours are 0.4 % of the cohesion of seven (6,2) tubes; of wider tubes they are nothing.
TEST(OtherCodes, ThinTubesReachTheirSecondNeighbours) {
  const ParameterSet thin = read_parameters(ROPEWALK_SOURCE_DIR "/tests/validate/cnt-6-2-tersoff.toml");
  const WallsIntegral integral = surface_integral(thin);
  const Well pair = integral.parallel_well();
  EXPECT_NEAR(rope_energy(integral, 7, pair.distance) / (12 * pair.energy), 1.0039, 2e-4);
  const Case& cohesion = find_case("hexagonal-cohesion");
  EXPECT_TRUE(test::misses(test::run_with(thin, cohesion)).empty());
  EXPECT_FALSE(test::misses(test::run_with(thin, cohesion, wrong_contact(1.01))).empty());
}

// Two long rows of beads at rest have the spacing and the cohesion of the tubes.
TEST(OtherCodes, BeadsHaveTheMeanCohesion) {
  const ParameterSet set = shipped();
  const Well pair = surface_integral(set).parallel_well();
  const BeadLaw law(pair.distance, pair.energy, set.element_length);
  const auto mean = [&](double distance) {
    double sum = 0;
    for (int k = -8000; k < 8000; ++k)
      sum += law.energy({}, {distance, 0, 0.01 * (k + 0.5)}, Vector3::UnitZ(), Vector3::UnitZ());
    return 0.01 * sum / (set.element_length * set.element_length);
  };
  EXPECT_NEAR(mean(pair.distance), pair.energy, 1e-4 * std::fabs(pair.energy));
  EXPECT_GT(mean(pair.distance - 0.01), mean(pair.distance));
  EXPECT_GT(mean(pair.distance + 0.01), mean(pair.distance));
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk::validate
