// Cases of theory and of other codes: green with the shipped sets, red under the faults that they are to see.
#include <gtest/gtest.h>

#include "validate/support.hpp"

namespace ropewalk {

namespace {

using test::expect_green;
using test::run;

TEST(TheoryCases, StretchAndCantilever) {
  const Case c = stretch_and_cantilever_case();
  expect_green(c);
  for (const Fault& fault : {test::stiffer_stretch(), test::stiffer_bend(), test::softer_twist()})
    EXPECT_FALSE(run(c, fault).holds());
}

TEST(TheoryCases, EulerBuckling) {
  const Case c = euler_buckling_case();
  expect_green(c);
  EXPECT_FALSE(run(c, test::stiffer_bend()).holds());
}

TEST(TheoryCases, Greenhill) {
  const Case c = greenhill_case();
  expect_green(c);
  EXPECT_FALSE(run(c, test::stiffer_bend()).holds());
}

TEST(TheoryCases, MichellRing) {
  const Case c = michell_ring_case();
  expect_green(c);
  for (const Fault& fault : {test::stiffer_bend(), test::softer_twist()}) EXPECT_FALSE(run(c, fault).holds());
}

TEST(TheoryCases, WaveSpeeds) {
  const Case c = wave_speeds_case();
  expect_green(c);
  for (const Fault& fault : {test::stiffer_stretch(), test::softer_twist()}) EXPECT_FALSE(run(c, fault).holds());
}

TEST(TheoryCases, RingEnergy) {
  const Case c = ring_energy_case();
  expect_green(c);
  EXPECT_FALSE(run(c, test::stiffer_bend()).holds());
}

TEST(TheoryCases, CrossingTorque) {
  const Case c = crossing_torque_case();
  expect_green(c);
  EXPECT_FALSE(run(c, test::twice_the_contact()).holds());
}

TEST(TheoryCases, PeelingForce) {
  const Case c = peeling_force_case();
  expect_green(c);
  EXPECT_FALSE(run(c, test::twice_the_contact()).holds());
}

TEST(TheoryCases, HexagonalCohesion) {
  const Case c = hexagonal_cohesion_case();
  expect_green(c);
  EXPECT_FALSE(run(c, test::twice_the_contact()).holds());
}

TEST(TheoryCases, AdhesiveRing) {
  const Case c = adhesive_ring_case();
  expect_green(c);
  for (const Fault& fault : {test::stiffer_bend(), test::twice_the_contact()}) EXPECT_FALSE(run(c, fault).holds());
}

TEST(CodesCases, IsotropicContact) {
  const Case c = isotropic_contact_case();
  expect_green(c);
  EXPECT_FALSE(run(c, test::twice_the_contact()).holds());
}

TEST(CodesCases, LegacyTorque) {
  const Case c = legacy_torque_case();
  expect_green(c);
  EXPECT_FALSE(run(c, test::missing_torque()).holds());
}

TEST(CodesCases, ParallelBond) {
  const Case c = parallel_bond_case();
  expect_green(c);
  EXPECT_FALSE(run(c, test::stiffer_bend()).holds());
}

}  // namespace
}  // namespace ropewalk
