#include "model/tube.hpp"

#include <gtest/gtest.h>

namespace ropewalk {
namespace {
namespace UNIT {

// Textbook values with a = 0.246 nm: armchair, zigzag and chiral.
TEST(Tube, Armchair) {
  const Chirality c{10, 10};
  EXPECT_NEAR(tube_radius(c), 3 * 10 * 0.246 / std::sqrt(3.0) / (2 * units::pi), 1e-12);
  EXPECT_NEAR(translational_period(c), 0.246, 1e-12);
  EXPECT_NEAR(atoms_per_length(c) * translational_period(c), 40, 1e-9);
  EXPECT_NEAR(chiral_angle(c), units::pi / 6, 1e-12);
}

TEST(Tube, Zigzag) {
  const Chirality c{17, 0};
  EXPECT_NEAR(circumference(c), 17 * 0.246, 1e-12);
  EXPECT_NEAR(translational_period(c), std::sqrt(3.0) * 0.246, 1e-12);
  EXPECT_NEAR(atoms_per_length(c) * translational_period(c), 68, 1e-9);
  EXPECT_NEAR(chiral_angle(c), 0, 1e-12);
}

// Atoms per period of any tube: 4 (n^2 + nm + m^2) / gcd(2n + m, 2m + n).
TEST(Tube, AtomsPerPeriodAreWhole) {
  for (const auto& [c, atoms] : {std::pair{Chirality{6, 4}, 152}, std::pair{Chirality{8, 2}, 56},
                                 std::pair{Chirality{12, 6}, 168}, std::pair{Chirality{16, 4}, 112}})
    EXPECT_NEAR(atoms_per_length(c) * translational_period(c), atoms, 1e-9) << c.n << "," << c.m;
}

TEST(Tube, ValidityOfIndices) {
  EXPECT_TRUE((Chirality{5, 0}.valid()));
  EXPECT_FALSE((Chirality{0, 0}.valid()));
  EXPECT_TRUE((Chirality{4, 5}.valid())) << "the mirror image of (5,4)";
  EXPECT_TRUE((Chirality{4, 5}.chiral()));
  EXPECT_FALSE((Chirality{5, 5}.chiral() || Chirality{5, 0}.chiral()));
  EXPECT_FALSE((Chirality{4, -1}.valid()));
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
