// Every registered case holds, explains itself, misses under each fault that it names in `turns_red`, and does not
// change under those of `stays_green`. The tests read the register: a new case is tested without a line here.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ostream>
#include <string>
#include <vector>

#include "report/formula.hpp"
#include "validate/support.hpp"

namespace ropewalk::validate {
namespace {
namespace UNIT {

struct Trial {
  const Case* validation_case;
  Case::Red red;  // the fault to put in, and the checks that must miss
};

// Part of the test's name: letters, digits and underscores.
std::string name_of(const Trial& trial) {
  const std::string fault = trial.red.fault.name();
  std::string name = trial.validation_case->name + (fault.empty() ? "" : "_" + fault);
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

void PrintTo(const Trial& trial, std::ostream* out) { *out << name_of(trial); }

std::string test_name(const ::testing::TestParamInfo<Trial>& info) { return name_of(info.param); }

std::vector<Trial> trials_without_fault() {
  std::vector<Trial> trials;
  for (const Case& c : all_cases()) trials.push_back({&c, {}});
  return trials;
}

std::vector<Trial> trials_that_turn_red() {
  std::vector<Trial> trials;
  for (const Case& c : all_cases())
    for (const Case::Red& red : c.turns_red) trials.push_back({&c, red});
  return trials;
}

std::vector<Trial> trials_that_stay_green() {
  std::vector<Trial> trials;
  for (const Case& c : all_cases())
    for (const Fault& fault : c.stays_green) trials.push_back({&c, {fault, {}}});
  return trials;
}

void expect_texts(const Case& c) {
  for (const std::string& text : {c.name, c.title, c.why, c.setup, c.oracle, c.literature})
    EXPECT_FALSE(text.empty()) << c.name;
  if (c.group == Case::Group::atoms) {
    EXPECT_NE(c.literature.find("DOI"), std::string::npos) << c.name;
  }
  EXPECT_FALSE(c.turns_red.empty()) << c.name << ": a case that no fault turns red tests nothing";
}

// Pieces between backquotes are formulas or one word, as in `auto`.
void expect_formulas(const std::string& text) {
  EXPECT_EQ(std::count(text.begin(), text.end(), '`') % 2, 0) << text;
  const std::string html = with_formulas(text);
  for (std::size_t at = 0; (at = html.find("<code>", at)) != std::string::npos;) {
    at += 6;
    const std::string code = html.substr(at, html.find("</code>", at) - at);
    EXPECT_EQ(code.find_first_not_of("abcdefghijklmnopqrstuvwxyz"), std::string::npos) << code << " in: " << text;
  }
}

void expect_formulas(const Case& c, const CaseResult& result) {
  for (const std::string& text : {c.why, c.setup, c.oracle}) expect_formulas(text);
  for (const std::string& text : result.remarks) expect_formulas(text);
  for (const CaseFigure& figure : result.figures) {
    expect_formulas(figure.caption);
    for (const ChartLine& line : figure.chart.lines)
      EXPECT_EQ(line.name.find('`'), std::string::npos) << "a drawing has no formulas: " << line.name;
  }
  for (const Limit& l : result.limits) expect_formulas(l.method + l.how);
  for (const Check& check : result.checks) expect_formulas(check.name + check.note);
}

void expect_figures_and_sources(const Case& c, const CaseResult& result) {
  const std::size_t least = c.group == Case::Group::atoms ? 2 : 1;
  EXPECT_GE(result.figures.size(), least);
  EXPECT_GE(result.sources.size(), least);
  EXPECT_FALSE(result.remarks.empty());
  for (const CaseFigure& figure : result.figures) {
    EXPECT_TRUE(can_draw(figure.chart)) << figure.chart.title;
    EXPECT_FALSE(figure.caption.empty()) << figure.chart.title;
  }
}

// A limit has its place on the map, and the found value agrees with theory.
void expect_limits(const Case& c, const CaseResult& result) {
  EXPECT_EQ(c.group == Case::Group::stability, !result.limits.empty());
  for (const Limit& l : result.limits) {
    EXPECT_NEAR(l.found / l.theory, 1, 0.05) << l.method;
    EXPECT_FALSE(l.how.empty()) << l.method;
  }
}

class ValidationCase : public ::testing::TestWithParam<Trial> {};

TEST_P(ValidationCase, HoldsAndExplainsItself) {
  const Case& c = *GetParam().validation_case;
  expect_texts(c);
  const CaseResult result = test::run(c);
  ASSERT_FALSE(result.checks.empty());
  for (const Check& check : result.checks) EXPECT_TRUE(std::isfinite(check.value)) << check.name;
  for (const std::string& name : test::misses(result)) {
    const Check& check = test::check_of(result, name);
    ADD_FAILURE() << check.name << ": " << check.value << " against " << check.reference;
  }
  for (const Case::KnownMiss& known : c.known_misses) {
    const auto is_known = [&](const Check& check) { return check.name == known.check; };
    const auto at = std::find_if(result.checks.begin(), result.checks.end(), is_known);
    ASSERT_NE(at, result.checks.end()) << "there is no check \"" << known.check << "\"";
    EXPECT_GT(std::fabs(at->difference()), at->tolerance) << known.check << " is no miss";
  }
  expect_formulas(c, result);
  expect_figures_and_sources(c, result);
  expect_limits(c, result);
}

class WrongParameter : public ::testing::TestWithParam<Trial> {};

TEST_P(WrongParameter, TurnsTheCaseRed) {
  const Trial& trial = GetParam();
  ASSERT_FALSE(trial.red.fault.name().empty()) << "no parameter is wrong";
  const std::set<std::string> missed = test::misses(test::run(*trial.validation_case, trial.red.fault));
  EXPECT_FALSE(missed.empty());
  for (const std::string& part : trial.red.checks)
    EXPECT_TRUE(std::any_of(missed.begin(), missed.end(),
                            [&](const std::string& name) { return name.find(part) != std::string::npos; }))
        << part << " holds";
}

class UnrelatedParameter : public ::testing::TestWithParam<Trial> {};

TEST_P(UnrelatedParameter, LeavesTheCaseGreen) {
  const Trial& trial = GetParam();
  ASSERT_FALSE(trial.red.fault.name().empty()) << "no parameter is wrong";
  EXPECT_TRUE(test::misses(test::run(*trial.validation_case, trial.red.fault)).empty());
}

INSTANTIATE_TEST_SUITE_P(Cases, ValidationCase, ::testing::ValuesIn(trials_without_fault()), test_name);
INSTANTIATE_TEST_SUITE_P(Cases, WrongParameter, ::testing::ValuesIn(trials_that_turn_red()), test_name);
INSTANTIATE_TEST_SUITE_P(Cases, UnrelatedParameter, ::testing::ValuesIn(trials_that_stay_green()), test_name);

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk::validate
