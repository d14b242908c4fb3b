// The Lennard-Jones law that acts between two shells of two species.
#include "model/honeycomb.hpp"

#include <gtest/gtest.h>

namespace ropewalk {
namespace {
namespace UNIT {

double energy(const PairLaw& law, double d) {
  const double s6 = std::pow(law.sigma / d, 6);
  return 4 * law.epsilon * s6 * (s6 - 1);
}

TEST(Honeycomb, LawOfShellsIsTheMeanOverThePairsOfSpecies) {
  const PairLaw a{4e-3, 0.36}, b{3e-3, 0.32}, ab = mixed_law(a, b);
  EXPECT_NEAR(ab.epsilon, std::sqrt(12.0) * 1e-3, 1e-15);
  EXPECT_NEAR(ab.sigma, 0.34, 1e-15);
  const PairLaw shell = shell_law({a, ab, b});
  for (const double d : {0.3, 0.34, 0.5, 1.0})
    EXPECT_NEAR(energy(shell, d), 0.25 * (energy(a, d) + 2 * energy(ab, d) + energy(b, d)), 1e-15) << d;
  const PairLaw alike = shell_law({a, a, a});
  EXPECT_NEAR(alike.epsilon, a.epsilon, 1e-15);
  EXPECT_NEAR(alike.sigma, a.sigma, 1e-15);
}

TEST(Honeycomb, CarbonIsTheDefault) {
  const Honeycomb carbon;
  EXPECT_TRUE(carbon.carbon() && carbon.one_species());
  EXPECT_EQ(carbon.mean_mass(), units::carbon_mass);
  EXPECT_EQ(carbon.stem(), "cnt");
  Honeycomb other;
  other.name = "BN";
  other.species = {"B", "N"};
  other.atomic_weight = {10, 14};
  EXPECT_EQ(other.stem(), "bn");
  EXPECT_FALSE(other.one_species());
  EXPECT_NEAR(other.mean_mass(), 12 * units::atomic_mass, 1e-15 * units::atomic_mass);
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
