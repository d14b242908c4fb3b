// The ropes of other codes that cases compare with: each has the physics that it stands for.
#include <gtest/gtest.h>

#include <cmath>

#include "cases/common/bead_law.hpp"
#include "cases/common/driven_rope.hpp"
#include "runner/runner.hpp"
#include "validate/support.hpp"

namespace ropewalk::validate {
namespace {
namespace UNIT {

ParameterSet shipped() { return test::shipped("cnt-10-10-tersoff"); }

BeadLaw bead_law(const ParameterSet& set, double cutoff) {
  const Well pair = surface_integral(set).parallel_well();
  return {pair.distance, pair.energy, set.element_length, cutoff};
}

// At rest, the moment of the beads is the derivative of their energy.
TEST(OtherCodes, BeadsAreConservative) {
  ParameterSet set = shipped();
  const auto law = std::make_shared<const BeadLaw>(bead_law(set, 4));
  set.bond.twist = set.bond.shear = 0;
  GrippedRope rope(set, 8, law, line_parallel_well(set.line->density).distance);
  rope.interaction.precision = Interaction::Precision::full;
  const double h = 1e-3;
  std::vector<double> energy, moment;
  for (const double by : {0.3 - h, h, h}) {
    rope.turn(by);
    rope.relax(1e-5);
    energy.push_back(rope.forces.energy.potential());
    moment.push_back(rope.moment());
  }
  EXPECT_NEAR(moment[1], (energy[2] - energy[0]) / (2 * h), 1e-4 * moment[1]);
}

// Beads whose bonds are joined by hinges, by another program: 16.19 eV, an end moment of 32.06 eV and a bending
// energy of 10.91 eV. Grips that hold orientations would make these 9 % too large, as a tube that is a bond
// shorter.
TEST(OtherCodes, GripsOfBeadsHoldPlacesAlone) {
  const CaseResult result = test::run(find_case("rope-bead-spring"));
  EXPECT_NEAR(test::check_of(result, "beads: twisting energy").value, 16.19, 0.04 * 16.19);
  EXPECT_NEAR(test::check_of(result, "beads: end moment").value, 32.06, 0.04 * 32.06);
  EXPECT_NEAR(test::check_of(result, "beads: bending energy").value, 10.91, 0.04 * 10.91);
}

// Second neighbours are 0.4 % of the cohesion of seven (6,2) tubes; of wider tubes they are nothing.
TEST(OtherCodes, ThinTubesReachTheirSecondNeighbours) {
  const ParameterSet thin = read_parameters(ROPEWALK_SOURCE_DIR "/tests/validate/cnt-6-2-tersoff.toml");
  const PairIntegral integral = surface_integral(thin);
  const Well pair = integral.parallel_well();
  EXPECT_NEAR(rope_energy(integral, 7, pair.distance) / (12 * pair.energy), 1.0039, 2e-4);
  for (const char* name : {"rope-bead-spring", "hexagonal-cohesion"}) {
    EXPECT_TRUE(test::misses(test::run_with(thin, find_case(name))).empty()) << name;
    EXPECT_FALSE(test::misses(test::run_with(thin, find_case(name), wrong_contact(1.01))).empty()) << name;
  }
}

// Two long rows of beads at rest have the spacing and the cohesion of the tubes.
TEST(OtherCodes, BeadsHaveTheMeanCohesion) {
  const ParameterSet set = shipped();
  const Well pair = surface_integral(set).parallel_well();
  const BeadLaw law = bead_law(set, BeadLaw::uncut);
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

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk::validate
