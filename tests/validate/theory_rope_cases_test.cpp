// Cases of theory on folds and ropes: green with the shipped sets, red under the faults that they are to see.
#include <gtest/gtest.h>

#include "validate/support.hpp"

namespace ropewalk {

namespace {

using test::expect_green;
using test::run;

TEST(TheoryRopeCases, Racket) {
  const Case c = racket_case();
  expect_green(c);
  for (const Fault& fault : {test::stiffer_bend(), test::twice_the_contact()}) EXPECT_FALSE(run(c, fault).holds());
}

TEST(TheoryRopeCases, HelixThreshold) {
  const Case c = helix_threshold_case();
  expect_green(c);
  for (const Fault& fault : {test::stiffer_bend(), test::stiffer_stretch()}) EXPECT_FALSE(run(c, fault).holds());
}

TEST(TheoryRopeCases, PackingCharge) {
  const Case c = packing_charge_case();
  expect_green(c);
  EXPECT_FALSE(run(c, test::twice_the_contact()).holds());
}

}  // namespace
}  // namespace ropewalk
