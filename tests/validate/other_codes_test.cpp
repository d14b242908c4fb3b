// The ropes of other codes that cases compare with: each has the physics that it stands for.
#include <gtest/gtest.h>

#include <cmath>

#include "cases/common/bead_rope.hpp"
#include "cases/common/driven_rope.hpp"
#include "validate/support.hpp"

namespace ropewalk::validate {
namespace {

ParameterSet shipped() { return test::shipped("cnt-10-10-tersoff"); }

BeadLaw bead_law(const ParameterSet& set) {
  const Well pair = surface_integral(set).parallel_well();
  return {pair.distance, pair.energy, set.element_length};
}

// At rest, the moment of the beads is the derivative of their energy.
TEST(OtherCodes, BeadsAreConservative) {
  const ParameterSet set = shipped();
  BeadRope rope(GrippedRope(set, 8, "line"), bead_law(set));
  const double h = 1e-3;
  rope.turn(0.3 - h);
  rope.relax();
  const double before = rope.total();
  rope.turn(h);
  rope.relax();
  const double moment = rope.moment();
  rope.turn(h);
  rope.relax();
  EXPECT_NEAR(moment, (rope.total() - before) / (2 * h), 1e-4 * moment);
}

// Two long rows of beads at rest have the spacing and the cohesion of the tubes.
TEST(OtherCodes, BeadsHaveTheMeanCohesion) {
  const ParameterSet set = shipped();
  const Well pair = surface_integral(set).parallel_well();
  const BeadLaw law = bead_law(set);
  const auto mean = [&](double distance) {
    double sum = 0;
    for (int k = -8000; k < 8000; ++k) sum += law.energy(distance * distance + std::pow(0.01 * (k + 0.5), 2));
    return 0.01 * sum / (set.element_length * set.element_length);
  };
  EXPECT_NEAR(mean(pair.distance), pair.energy, 1e-4 * std::fabs(pair.energy));
  EXPECT_GT(mean(pair.distance - 0.01), mean(pair.distance));
  EXPECT_GT(mean(pair.distance + 0.01), mean(pair.distance));
}

// A held rope at rest stays at rest, with bonds of either kind.
TEST(OtherCodes, DrivenRopeRests) {
  for (const auto bonds : {DrivenRope::Bonds::total_energy, DrivenRope::Bonds::incremental}) {
    DrivenRope rope(shipped(), 4, bonds, 0.5, 1.5);
    rope.rest(10);
    const double energy = rope.energy();
    rope.rest(2);
    EXPECT_NEAR(rope.energy(), energy, 1e-6);
    EXPECT_NEAR(rope.moment(), 0, 1e-4);
  }
}

}  // namespace
}  // namespace ropewalk::validate
