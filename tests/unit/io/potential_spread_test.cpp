// The spread between potentials follows from the shipped sets of one tube.
#include "io/potential_spread.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "io/data_files.hpp"
#include "io/parameters_toml.hpp"
#include "report/page.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

TEST(PotentialSpread, IsThatOfTheShippedSets) {
  double sum = 0, squares = 0;
  for (const PotentialStiffness& p : potentials_of_carbon) {
    const ParameterSet set = read_parameters(data_directory() + "/parameters/cnt-10-10-" + p.potential + ".toml");
    EXPECT_NEAR(p.EA / find_quantity(set, "bond.EA")->value, 1, 1e-5) << p.potential;
    EXPECT_NEAR(p.EI / find_quantity(set, "bond.EI")->value, 1, 1e-5) << p.potential;
    EXPECT_NEAR(p.GJ / find_quantity(set, "bond.GJ")->value, 1, 1e-5) << p.potential;
    sum += p.EA;
    squares += p.EA * p.EA;
  }
  EXPECT_NEAR(potential_spread("bond.EA"), std::sqrt((squares - sum * sum / 4) / 3) / (sum / 4), 1e-12);
  EXPECT_NEAR(potential_spread("bond.EA"), 0.135, 0.001);
  EXPECT_NEAR(potential_spread("bond.GJ"), 0.194, 0.001);
  EXPECT_EQ(potential_spread("bond.kGA"), potential_spread("bond.GJ"));
  EXPECT_EQ(potential_spread("contact.line.K"), 0);
  // One wall: the stiffnesses go up and down together.
  EXPECT_GT(potential_covariance("bond.EA", "bond.EI"),
            0.99 * potential_spread("bond.EA") * potential_spread("bond.EI"));
}

TEST(PotentialSpread, StandsBehindTheErrorOfTheFit) {
  const ParameterSet set = read_parameters(data_directory() + "/parameters/cnt-10-10-tersoff.toml");
  EXPECT_EQ(measured_text(*find_quantity(set, "bond.EA"), true), "1518.960 ± 0.037 ± 210 (potential) nN");
  EXPECT_EQ(measured_text(*find_quantity(set, "tube.radius")).find("potential"), std::string::npos);
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
