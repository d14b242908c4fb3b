// Cases of theory and of other codes: green with the shipped sets, red under the faults that they are to see.
#include <gtest/gtest.h>

#include "core/case.hpp"
#include "io/data_files.hpp"
#include "io/parameters_toml.hpp"

namespace ropewalk {

Case stretch_and_cantilever_case();
Case euler_buckling_case();
Case greenhill_case();
Case michell_ring_case();
Case wave_speeds_case();
Case ring_energy_case();
Case crossing_torque_case();
Case peeling_force_case();
Case hexagonal_cohesion_case();
Case adhesive_ring_case();
Case isotropic_contact_case();
Case legacy_torque_case();
Case parallel_bond_case();

namespace {

Fault wrong_EA() {
  Fault f;
  f.EA = 1.1;
  return f;
}
Fault wrong_EI() {
  Fault f;
  f.EI = 1.1;
  return f;
}
Fault wrong_GJ() {
  Fault f;
  f.GJ = 0.9;
  return f;
}
Fault deep_contact() {
  Fault f;
  f.contact = 2;
  return f;
}
Fault missing_torque() {
  Fault f;
  f.missing_torque = true;
  return f;
}

CaseResult run(const Case& c, const Fault& fault = {}) {
  CaseContext context;
  context.parameters = [](const std::string& name) { return read_parameters(find_parameters(name, "")); };
  context.progress = [](const std::string&) {};
  context.fault = fault;
  return c.run(context);
}

// All checks hold, figures can be drawn, and the page has something to say.
void expect_green(const Case& c) {
  const CaseResult result = run(c);
  ASSERT_FALSE(result.checks.empty());
  for (const Check& check : result.checks) {
    EXPECT_TRUE(check.informative || check.holds())
        << c.name << ": " << check.name << " " << check.value << " against " << check.reference;
  }
  ASSERT_FALSE(result.figures.empty());
  for (const CaseFigure& figure : result.figures) {
    EXPECT_TRUE(can_draw(figure.chart)) << figure.chart.title;
    EXPECT_FALSE(figure.caption.empty());
  }
  for (const std::string& text : {c.name, c.title, c.why, c.setup, c.oracle, c.literature})
    EXPECT_FALSE(text.empty());
  EXPECT_FALSE(result.remarks.empty());
  EXPECT_FALSE(result.sources.empty());
}

TEST(TheoryCases, StretchAndCantilever) {
  const Case c = stretch_and_cantilever_case();
  expect_green(c);
  for (const Fault& fault : {wrong_EA(), wrong_EI(), wrong_GJ()}) EXPECT_FALSE(run(c, fault).holds());
}

TEST(TheoryCases, EulerBuckling) {
  const Case c = euler_buckling_case();
  expect_green(c);
  EXPECT_FALSE(run(c, wrong_EI()).holds());
}

TEST(TheoryCases, Greenhill) {
  const Case c = greenhill_case();
  expect_green(c);
  EXPECT_FALSE(run(c, wrong_EI()).holds());
}

TEST(TheoryCases, MichellRing) {
  const Case c = michell_ring_case();
  expect_green(c);
  for (const Fault& fault : {wrong_EI(), wrong_GJ()}) EXPECT_FALSE(run(c, fault).holds());
}

TEST(TheoryCases, WaveSpeeds) {
  const Case c = wave_speeds_case();
  expect_green(c);
  for (const Fault& fault : {wrong_EA(), wrong_GJ()}) EXPECT_FALSE(run(c, fault).holds());
}

TEST(TheoryCases, RingEnergy) {
  const Case c = ring_energy_case();
  expect_green(c);
  EXPECT_FALSE(run(c, wrong_EI()).holds());
}

TEST(TheoryCases, CrossingTorque) {
  const Case c = crossing_torque_case();
  expect_green(c);
  EXPECT_FALSE(run(c, deep_contact()).holds());
}

TEST(TheoryCases, PeelingForce) {
  const Case c = peeling_force_case();
  expect_green(c);
  EXPECT_FALSE(run(c, deep_contact()).holds());
}

TEST(TheoryCases, HexagonalCohesion) {
  const Case c = hexagonal_cohesion_case();
  expect_green(c);
  EXPECT_FALSE(run(c, deep_contact()).holds());
}

TEST(TheoryCases, AdhesiveRing) {
  const Case c = adhesive_ring_case();
  expect_green(c);
  for (const Fault& fault : {wrong_EI(), deep_contact()}) EXPECT_FALSE(run(c, fault).holds());
}

TEST(CodesCases, IsotropicContact) {
  const Case c = isotropic_contact_case();
  expect_green(c);
  EXPECT_FALSE(run(c, deep_contact()).holds());
}

TEST(CodesCases, LegacyTorque) {
  const Case c = legacy_torque_case();
  expect_green(c);
  EXPECT_FALSE(run(c, missing_torque()).holds());
}

TEST(CodesCases, ParallelBond) {
  const Case c = parallel_bond_case();
  expect_green(c);
  EXPECT_FALSE(run(c, wrong_EI()).holds());
}

}  // namespace
}  // namespace ropewalk
