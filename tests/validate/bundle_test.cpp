// Facts about bent and warm bundles beyond the verdicts of their cases.
#include <gtest/gtest.h>

#include "runner/runner.hpp"
#include "validate/support.hpp"

namespace ropewalk::validate {
namespace {
namespace UNIT {

using test::check_of;

TEST(BentBundle, StaysWithinWhatItsRemarksSay) {
  const CaseResult result = test::run(find_case("bent-bundle"));
  EXPECT_EQ(result.figures.size(), 4u);
  EXPECT_LT(check_of(result, "bending energy, free, 24 deg").difference(), 0.08 * 11.44);
  EXPECT_LT(check_of(result, "bending energy, glued, 9 deg").difference(), 0.02);
}

// Rigid walls do not vibrate: the elements have a fifth to three fifths of the changes that heat makes.
TEST(WarmBundle, MissesWhatTheWallsOfTheAtomsDo) {
  const CaseResult result = test::run(find_case("warm-bundle"));
  for (const char* name : {"expansion of the spacing", "loss of cohesion per length"}) {
    const Check& change = check_of(result, name);
    EXPECT_GT(change.value, 0.2 * change.reference) << name;
    EXPECT_LT(change.value, 0.6 * change.reference) << name;
  }
  EXPECT_TRUE(check_of(result, "loss of cohesion with that of vibrating walls").holds());
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk::validate
