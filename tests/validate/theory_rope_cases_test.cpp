// Cases of theory on folds and ropes: green with the shipped sets, red under the faults that they are to see.
#include <gtest/gtest.h>

#include "validate/support.hpp"

namespace ropewalk {

namespace {

using test::run;

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
