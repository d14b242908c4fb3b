// The twisted rope of atoms and of elements: how both are built, and what shear is worth.
#include "cases/common/twisted_rope.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "runner/runner.hpp"
#include "validate/support.hpp"

namespace ropewalk::validate {

namespace {
namespace UNIT {

TEST(TwistedRope, DrawsItsEnergiesItsMomentAndTheirResiduals) {
  EXPECT_EQ(test::run(find_case("rope-7-long")).figures.size(), 5u);
}

// Tubes of six diameters, clamped, shear where they bend: bonds that cannot are too stiff at every angle.
TEST(TwistedRope, WideShortTubesNeedTheirShear) {
  const CaseResult result = test::run(find_case("rope-7-short"));
  EXPECT_TRUE(result.holds());
  int rigid = 0;
  for (const Check& c : result.checks) {
    if (c.name.find("(10,10): twisting energy with bonds rigid in shear") == std::string::npos) continue;
    ++rigid;
    EXPECT_GT(c.difference(), 0.05) << c.name;
  }
  EXPECT_EQ(rigid, 6);
}

// In an armchair tube the clamped length counts rows of atoms: one row more than the free ones, and the last held
// rows bound it.
TEST(TwistedRope, ClampedLengthReachesFromHeldRowToHeldRow) {
  const TwistedRope rope{"", 10, 3, 4};
  const ParameterSet set = test::shipped("cnt-5-5-tersoff");
  EXPECT_NEAR(clamped_length(rope, set), 11 * row_distance(set), 1e-12);
  for (const RopeTube& tube : rope_atoms(rope, set)) {
    const auto by_height = [](const Vector3& a, const Vector3& b) { return a.z() < b.z(); };
    const double below = std::max_element(tube.below.begin(), tube.below.end(), by_height)->z();
    const double above = std::min_element(tube.above.begin(), tube.above.end(), by_height)->z();
    EXPECT_NEAR(above - below, clamped_length(rope, set), 1e-9);
    EXPECT_EQ(tube.free.size(), 10u * 10u);  // ten atoms in a row of (5,5)
    EXPECT_EQ(tube.below.size(), tube.above.size());
  }
}

// A chiral and a zigzag tube: the clamped length exceeds the free rows by the held halves of the bonds that cross
// the ends of the bands, less than two bonds' lengths.
TEST(TwistedRope, ClampedLengthOfAnyTubeExceedsTheFreeRowsByLessThanTwoBonds) {
  for (const char* name : {"cnt-6-4-tersoff", "cnt-8-2-tersoff", "cnt-9-0-tersoff"}) {
    const ParameterSet set = test::shipped(name);
    const TwistedRope rope = rope_of_length("", 4, set);
    const double more = clamped_length(rope, set) - rope.free_rows * row_distance(set);
    EXPECT_GT(more, 0.05) << name;
    EXPECT_LT(more, 0.285) << name;
    std::size_t atoms = 0;
    for (const RopeTube& tube : rope_atoms(rope, set)) {
      atoms += tube.below.size() + tube.free.size() + tube.above.size();
      EXPECT_EQ(tube.below.size(), tube.above.size()) << name;
    }
    EXPECT_NEAR(static_cast<double>(atoms) / 7,
                (rope.free_rows + 2 * rope.band_rows) * row_distance(set) * set.atoms_per_length, 1e-6);
  }
}

// Registries differ: no two tubes are turned and shifted alike.
TEST(TwistedRope, TubesAreTurnedAndShiftedAgainstEachOther) {
  const TwistedRope rope{"", 4, 1, 1};
  const ParameterSet set = test::shipped("cnt-5-5-tersoff");
  const std::vector<RopeTube> tubes = rope_atoms(rope, set);
  ASSERT_EQ(tubes.size(), 7u);
  for (std::size_t i = 0; i < tubes.size(); ++i)
    for (std::size_t j = i + 1; j < tubes.size(); ++j)
      EXPECT_GT(std::fabs(tubes[i].free[0].z() - tubes[j].free[0].z()), 1e-3) << i << " and " << j;
}

// An undamaged rope at rest pushes at its grips with nothing but its own shortening, and turns neither way.
TEST(TwistedRope, UntwistedElementsCarryNoMoment) {
  const TwistedRope rope{"", 32, 8, 6};
  const std::vector<TwistedState> states = twist_elements(rope, test::shipped("cnt-5-5-tersoff"), {0, 0.05}, true);
  ASSERT_EQ(states.size(), 2u);
  EXPECT_NEAR(states[0].moment, 0, 1e-2);
  EXPECT_NEAR(states[0].force, 0, 0.25);
  // Energy is the work of the moment, which starts at zero and rises in proportion.
  EXPECT_NEAR(states[1].total - states[0].total, 0.5 * 0.05 * states[1].moment,
              0.02 * (states[1].total - states[0].total));
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk::validate
