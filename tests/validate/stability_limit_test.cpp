// Cases of stability: the limits agree with theory, and another tube has other limits.
#include <gtest/gtest.h>

#include "cases/common/stability_limit.hpp"
#include "validate/support.hpp"

namespace ropewalk {
namespace {

using test::expect_green;
using test::run;

// No single stiffness sets all steps.
Fault stiffer_tubes() {
  Fault f;
  f.EA = f.EI = f.GJ = 1.2;
  return f;
}

TEST(LimitCases, ChainStep) {
  const Case c = limit_chain_step_case();
  expect_green(c);
  EXPECT_FALSE(run(c, stiffer_tubes()).holds());
}

TEST(LimitCases, ContactStep) {
  const Case c = limit_contact_step_case();
  expect_green(c);
  EXPECT_FALSE(run(c, stiffer_tubes()).holds());
}

TEST(LimitCases, Tunnelling) {
  const Case c = limit_tunnelling_case();
  expect_green(c);
  EXPECT_FALSE(run(c, test::twice_the_contact()).holds());
}

TEST(LimitCases, BondSlip) {
  const Case c = limit_bond_slip_case();
  expect_green(c);
  EXPECT_FALSE(run(c, test::softer_twist()).holds());
}

// The contact decides where it is many times as strong.
TEST(LimitCases, ContactStiffness) {
  const Case c = limit_contact_stiffness_case();
  expect_green(c);
  EXPECT_FALSE(run(c, test::twice_the_contact()).holds());
}

TEST(LimitCases, ElementLength) {
  const Case c = limit_element_length_case();
  expect_green(c);
  EXPECT_FALSE(run(c, test::stiffer_bend()).holds());
  EXPECT_FALSE(run(c, test::twice_the_contact()).holds());
}

TEST(LimitCases, Crossing) {
  const Case c = limit_crossing_case();
  expect_green(c);
  EXPECT_FALSE(run(c, test::twice_the_contact()).holds());
  EXPECT_FALSE(run(c, test::missing_torque()).holds());
}

TEST(LimitCases, ListSkin) {
  const Case c = limit_list_skin_case();
  expect_green(c);
  EXPECT_FALSE(run(c, test::twice_the_contact()).holds());
}

TEST(LimitCases, Fire) {
  const Case c = limit_fire_case();
  expect_green(c);
  EXPECT_FALSE(run(c, test::stiffer_bend()).holds());
}

TEST(LimitCases, NotFinite) {
  const Case c = limit_nan_case();
  expect_green(c);
  EXPECT_FALSE(run(c, test::softer_twist()).holds());
}

TEST(Limits, BisectionFindsTheStepAndTellsWhereThereIsNone) {
  const auto beyond_two = [](double x) { return x > 2; };
  EXPECT_NEAR(limit_between(beyond_two, 1, 5, 1e-4), 2, 4e-4);
  EXPECT_TRUE(std::isnan(limit_between(beyond_two, 3, 5)));
  EXPECT_TRUE(std::isnan(limit_between(beyond_two, 0, 1)));
}

}  // namespace
}  // namespace ropewalk
