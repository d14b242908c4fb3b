// Shared by the tests of the cases: the faults, and a case run with one of them on the stored references.
#pragma once

#include <gtest/gtest.h>

#include <cmath>

#include "cases/cases.hpp"
#include "io/data_files.hpp"
#include "io/parameters_toml.hpp"

namespace ropewalk::test {

inline Fault stiffer_stretch() {
  Fault f;
  f.EA = 1.1;
  return f;
}
inline Fault stiffer_bend() {
  Fault f;
  f.EI = 1.1;
  return f;
}
inline Fault softer_twist() {
  Fault f;
  f.GJ = 0.9;
  return f;
}
inline Fault twice_the_contact() {
  Fault f;
  f.contact = 2;
  return f;
}
inline Fault missing_torque() {
  Fault f;
  f.missing_torque = true;
  return f;
}

inline CaseContext stored_context() {
  CaseContext context;
  context.parameters = [](const std::string& name) { return read_parameters(find_parameters(name, "")); };
  context.references = ROPEWALK_SOURCE_DIR "/data/references";
  context.progress = [](const std::string&) {};
  return context;
}

inline CaseResult run(const Case& c, const Fault& fault = {}) {
  CaseContext context = stored_context();
  context.fault = fault;
  return c.run(context);
}

// All checks hold, figures can be drawn, and the page has something to say.
inline void expect_green(const Case& c) {
  const CaseResult result = run(c);
  ASSERT_FALSE(result.checks.empty());
  for (const Check& check : result.checks) {
    EXPECT_TRUE(check.informative || check.holds())
        << c.name << ": " << check.name << " " << check.value << " against " << check.reference;
    EXPECT_TRUE(std::isfinite(check.value)) << check.name;
  }
  ASSERT_FALSE(result.figures.empty());
  for (const CaseFigure& figure : result.figures) {
    EXPECT_TRUE(can_draw(figure.chart)) << figure.chart.title;
    EXPECT_FALSE(figure.caption.empty());
  }
  for (const std::string& text : {c.name, c.title, c.why, c.setup, c.oracle, c.literature})
    EXPECT_FALSE(text.empty());
  // A limit has its place on the map, and what was found agrees with theory.
  EXPECT_EQ(c.group == Case::Group::stability, !result.limits.empty()) << c.name;
  for (const Limit& l : result.limits) {
    EXPECT_NEAR(l.found / l.theory, 1, 0.05) << c.name << ": " << l.method;
    EXPECT_FALSE(l.how.empty()) << l.method;
  }
  EXPECT_FALSE(result.remarks.empty());
  EXPECT_FALSE(result.sources.empty());
}

}  // namespace ropewalk::test
