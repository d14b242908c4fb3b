// Verdicts, files and page that are made of the cases' numbers.
#include "runner/runner.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>

#include "core/checks.hpp"
#include "core/reference.hpp"
#include "io/files.hpp"
#include "io/parameters_toml.hpp"
#include "model/contact/line_parameters.hpp"
#include "model/error.hpp"
#include "validate/support.hpp"

namespace ropewalk::validate {
namespace {
namespace UNIT {

using ::testing::HasSubstr;
using ::testing::Not;

Check check(double value, double reference, double tolerance, bool relative = true) {
  Check c;
  c.name = "a <quantity>";
  c.value = value;
  c.reference = reference;
  c.tolerance = tolerance;
  c.relative = relative;
  c.unit = "eV";
  return c;
}

Outcome outcome_with(const std::vector<Check>& checks) {
  Outcome o;
  o.name = all_cases().front().name;
  o.result.checks = checks;
  return o;
}

TEST(ValidationCheck, HoldsWithinItsToleranceOnly) {
  EXPECT_TRUE(check(1.009, 1, 0.01).holds());
  EXPECT_FALSE(check(1.011, 1, 0.01).holds());
  EXPECT_FALSE(check(-0.989, -1, 0.01).holds());
  EXPECT_TRUE(check(-0.991, -1, 0.01).holds());
  EXPECT_TRUE(check(0.009, 0, 0.01, false).holds());
  EXPECT_FALSE(check(std::nan(""), 1, 0.01).holds());
  EXPECT_FALSE(check(1, 0, 0.01).holds()) << "a relative difference from nothing";
}

TEST(ValidationCheck, InformativeOnesDecideNothing) {
  Check c = check(2, 1, 0.01);
  EXPECT_EQ(outcome_with({c}).verdict(), Outcome::Verdict::misses);
  c.informative = true;
  EXPECT_EQ(outcome_with({c}).verdict(), Outcome::Verdict::holds);
  Outcome o = outcome_with({});
  o.error = "lmp is not installed";
  EXPECT_EQ(o.verdict(), Outcome::Verdict::failed);
}

// A declared miss that grows, or one that goes away, has to be looked at.
TEST(ValidationCheck, AKnownMissHoldsWhileItKeepsItsSize) {
  Check c = check(1.2, 1, 0.01);
  c.known = Check::Known{0.2, 0.03};
  EXPECT_TRUE(c.holds());
  c.value = 1.25;
  EXPECT_FALSE(c.holds());
  c.value = 1;
  EXPECT_FALSE(c.holds());
}

TEST(ValidationCase, IsNotApplicableToASetWithoutItsLaw) {
  const ParameterSet paper = test::shipped("cnt-10-10-paper"), thin = test::shipped("cnt-5-5-tersoff");
  EXPECT_NO_THROW(check_applicable(find_case("greenhill"), paper, {}));
  EXPECT_THROW(check_applicable(find_case("racket"), paper, {}), NotApplicable);
  const Case& warm = find_case("warm-bundle");
  EXPECT_NO_THROW(check_applicable(warm, thin, {thin}));
  EXPECT_THROW(check_applicable(warm, test::shipped("cnt-6-4-tersoff"), {thin}), NotApplicable);
}

// Atoms of one wall tell nothing about several, nor the other way round. Theory is of any tube.
TEST(ValidationCase, OfAtomsIsOfOneWallOrOfSeveral) {
  const ParameterSet one = test::shipped("cnt-10-10-tersoff"), two = test::shipped("cnt-5-5@10-10-tersoff");
  for (const Case& c : all_cases()) {
    std::vector<ParameterSet> shipped;
    for (const std::string& name : c.sets) shipped.push_back(test::shipped(name));
    const bool of_atoms = c.group == Case::Group::atoms || c.group == Case::Group::codes;
    if (c.name == "walls") {
      EXPECT_NO_THROW(check_applicable(c, two, shipped)) << c.name;
      EXPECT_THROW(check_applicable(c, one, shipped), NotApplicable) << c.name;
    } else if (of_atoms) {
      EXPECT_THROW(check_applicable(c, two, shipped), NotApplicable) << c.name;
    }
  }
  EXPECT_NO_THROW(check_applicable(find_case("greenhill"), two, {one}));
}

TEST(ValidationOutcome, NotApplicableIsNoMiss) {
  Outcome o = outcome_with({});
  o.not_applicable = "the set has no <law>";
  EXPECT_EQ(o.verdict(), Outcome::Verdict::not_applicable);
  const std::string page = validation_page({outcome_with({check(1, 1, 0.1)}), o}, {});
  EXPECT_THAT(page, HasSubstr("1 of 1 cases hold; 1 are not applicable"));
  EXPECT_THAT(page, HasSubstr("the set has no &lt;law&gt;"));
}

TEST(ValidationOutcome, NoSetThatMissesIsGood) {
  Outcome miss = outcome_with({check(1.011, 1, 0.01)}), other = miss, hold = outcome_with({check(1, 1, 0.01)});
  miss.name = "tube-bend";
  miss.sets = hold.sets = {{"mine", "hash", "(6,2)", "good", -1}};
  other.sets = {{"another", "other hash", "(9,1)", "good", -1}};
  EXPECT_EQ(grade_with_verdicts("good", "hash", {hold, other}), "good");
  EXPECT_EQ(grade_with_verdicts("good", "hash", {hold, miss}), "limited: it misses in tube-bend");
  EXPECT_EQ(grade_with_verdicts("limited: EA is known to 2 %", "hash", {miss}),
            "limited: EA is known to 2 %; it misses in tube-bend");
  EXPECT_THAT(page_facts({miss}).front(), HasSubstr("limited: it misses in tube-bend"));
}

TEST(ValidationOutcome, NamesTheTubesInItsTexts) {
  Outcome o = outcome_with({});
  o.tubes = "(7,3)";
  EXPECT_EQ(o.with_tubes("Two {tube} tubes, {tube}"), "Two (7,3) tubes, (7,3)");
  for (const Case& c : all_cases()) {
    if (!c.only_these.empty()) continue;
    for (const std::string& text : {c.title, c.why, c.setup, c.oracle})
      EXPECT_THAT(text, Not(HasSubstr("(10,10)"))) << c.name;
  }
}

TEST(ValidationOutcome, ComesBackFromItsFile) {
  Outcome o = outcome_with({check(1.5, 1, 0.1), check(std::nan(""), 1, 0.1)});
  o.key = "key";
  o.tubes = "(7,3)";
  o.sets = {{"cnt-7-3-tersoff", "hash", "(7,3)", "good", 0.01}};
  o.result.checks[0].known = Check::Known{0.5, 0.1};
  o.result.remarks = {"why"};
  o.result.sources = {"a.csv (stored)"};
  CaseFigure f;
  f.caption = "see";
  f.chart.title = "t";
  f.chart.x = {"angle", "deg"};
  f.chart.y = {"energy", "eV"};
  f.chart.lines = {{"model", {0, 1, 2}, {0, std::nan(""), 4}, 1}};
  f.chart.lines[0].points = true;
  f.labels = {{"first", "", "third"}};
  f.chart.lines.push_back({"stable", {0, 2, 2}, {0, 0, 4}});
  f.chart.lines[1].filled = true;
  o.result.figures = {f};
  o.result.limits = {{"time step", 66, 65, "fs", Limit::Guard::refused, "above the estimate"}};
  const std::string path = (std::filesystem::temp_directory_path() / "ropewalk-outcome.json").string();
  write_file_atomically(path, outcome_json(o));
  const Outcome back = read_outcome(path);
  EXPECT_EQ(outcome_json(back), outcome_json(o));
  const CaseFigure& drawn = back.result.figures[0];
  EXPECT_TRUE(std::isnan(drawn.chart.lines[0].y[1]));
  EXPECT_FALSE(drawn.chart.lines[0].filled);
  EXPECT_TRUE(drawn.chart.lines[1].filled);
  EXPECT_EQ(drawn.labels, f.labels);
  EXPECT_THAT(validation_page({back}, {}), HasSubstr(">third</text>"));
  write_file_atomically(path, "{}");
  EXPECT_THROW(read_outcome(path), InputError);
  std::filesystem::remove(path);
}

TEST(ValidationPage, TellsTheVerdictFirstAndEscapes) {
  const std::string good = validation_page({outcome_with({check(1, 1, 0.1)})}, {"fact"});
  EXPECT_THAT(good, HasSubstr("1 of 1 cases hold"));
  EXPECT_THAT(good, HasSubstr("a &lt;quantity&gt;"));
  EXPECT_THAT(good, Not(HasSubstr("✗")));
  const std::string bad = validation_page({outcome_with({check(2, 1, 0.1)})}, {});
  EXPECT_THAT(bad, HasSubstr("0 of 1 cases hold"));
  EXPECT_THAT(bad, HasSubstr("✗ misses"));
  EXPECT_LT(bad.find("✗ misses"), bad.find("<section"));
  EXPECT_THAT(bad, Not(HasSubstr("<script")));
}

TEST(ValidationPage, SetsFormulasOfAllItsTexts) {
  Outcome o = outcome_with({check(1, 1, 0.1)});
  o.result.checks[0].note = "note `a^2`";
  o.result.remarks = {"remark `b^2`"};
  o.result.figures.push_back(
      case_figure("Figure", {"x", ""}, {"y", ""}, "caption `c^2`", {model_points("points", {0, 1}, {0, 1})}));
  o.result.limits = {{"method `d^2`", 102, 100, "fs", Limit::Guard::stopped, "how `e^2`"}};
  const std::string page = validation_page({o}, {});
  for (const char* words : {"note a", "remark b", "caption c", "method d", "how e"}) {
    const std::string text = words, letter = text.substr(text.size() - 1);
    EXPECT_THAT(page, HasSubstr(text.substr(0, text.size() - 1) + "<math><msup><mi>" + letter +
                                "</mi><mn>2</mn></msup></math>"));
  }
  // The oracle of the case itself.
  EXPECT_THAT(page, HasSubstr("<b>Oracle.</b> <math>"));
}

TEST(ValidationPage, DrawsTheLimitsOnAMap) {
  Outcome o = outcome_with({check(1, 1, 0.1)});
  EXPECT_THAT(validation_page({o}, {}), Not(HasSubstr("The map")));
  o.result.limits = {{"step <of> a tube", 102, 100, "fs", Limit::Guard::stopped, "in words"},
                     {"another", 109, 100, "fs", Limit::Guard::none, "not needed"}};
  const std::string page = validation_page({o}, {});
  EXPECT_THAT(page, HasSubstr("The map"));
  EXPECT_THAT(page, HasSubstr("step &lt;of&gt; a tube"));
  EXPECT_THAT(page, HasSubstr("stopped with the reason"));
  EXPECT_THAT(page,
              HasSubstr("class=\"dot\" cx=\"108.0\""));  // 2 of the 10 % to one side of the strip's middle, 90
  EXPECT_THAT(page, HasSubstr("class=\"off\" cx=\"171.0\""));
}

Case named(const char* name, Case::Group group, int order) {
  Case c;
  c.name = name;
  c.group = group;
  c.order = order;
  return c;
}

TEST(ValidationCases, AreFoundByTheirNames) {
  for (const Case& c : all_cases()) EXPECT_EQ(&find_case(c.name), &c);
  EXPECT_THROW(find_case("no-such-case"), InputError);
}

// A linker drops objects of a static library that nothing refers to.
TEST(ValidationCases, AreRegisteredByEveryFile) {
  std::size_t files = 0;
  for (const char* group : {"theory", "atoms", "codes", "stability"})
    for (const auto& file :
         std::filesystem::recursive_directory_iterator(std::string(ROPEWALK_SOURCE_DIR "/validate/cases/") + group))
      files += file.path().extension() == ".cpp";
  EXPECT_EQ(all_cases().size(), files);
}

TEST(ValidationCases, AreSortedByGroupOrderAndName) {
  const std::vector<Case> cases =
      sorted_cases({named("d", Case::Group::stability, 0), named("c", Case::Group::theory, 2),
                    named("b", Case::Group::theory, 1), named("a", Case::Group::theory, 2)});
  std::string names;
  for (const Case& c : cases) names += c.name;
  EXPECT_EQ(names, "bacd");
}

TEST(ValidationCases, HaveNamesOfTheirOwn) {
  try {
    sorted_cases({named("ring", Case::Group::theory, 1), named("ring", Case::Group::codes, 2)});
    FAIL() << "two cases with one name";
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), HasSubstr("\"ring\""));
  }
}

TEST(ValidationFault, IsNamedByItsChanges) {
  EXPECT_EQ(Fault{}.name(), "");
  EXPECT_EQ(wrong_EA(1.1).name(), "EA_plus_10_percent");
  EXPECT_EQ(wrong_GJ(0.9).name(), "GJ_minus_10_percent");
  EXPECT_EQ(wrong_contact(2).name(), "contact_plus_100_percent");
  EXPECT_EQ(without_torque().name(), "missing_torque");
  EXPECT_EQ(wrong_stiffnesses(1.2).name(), "EA_plus_20_percent_EI_plus_20_percent_GJ_plus_20_percent");
}

TEST(Reference, ReadsWhatItWritesAndSaysWhatIsWrong) {
  const std::string path = (std::filesystem::temp_directory_path() / "ropewalk-reference.csv").string();
  ReferenceTable t;
  t.add("title", "energy: of two tubes");
  t.add("lammps", "29 Sep 2021");
  t.columns = {"distance_nm", "energy_eV"};
  t.rows = {{1.6, -12.25}, {1.7, -13.5}};
  write_file_atomically(path, reference_csv(t));
  const ReferenceTable back = read_reference(path);
  EXPECT_EQ(back.origin, t.origin);
  EXPECT_EQ(back.column("energy_eV"), (std::vector<double>{-12.25, -13.5}));
  EXPECT_THROW(back.column("torque"), std::out_of_range);
  write_file_atomically(path, "# title: x\na,b\n1,2\n1,x\n");
  try {
    read_reference(path);
    FAIL();
  } catch (const InputError& e) {
    EXPECT_EQ(e.place().line, 4);
  }
  std::filesystem::remove(path);
}

// References in a folder of their own, for a copy of a shipped set.
class StoredReference : public ::testing::Test {
 protected:
  void SetUp() override {
    dir = std::filesystem::temp_directory_path() / ("ropewalk-references-" + std::to_string(getpid()));
    std::filesystem::create_directories(dir / "work");
    set = test::shipped("cnt-5-5-tersoff");
    set.path = (dir / "mine.toml").string();
    set.name = "mine";
    t.columns = {"x", "e"};
    t.rows = {{0, 0}, {1, 10}};
    t.add("potential", "tersoff (BNC.tersoff, hash " + provenance_value(set, "potential_hash") + ")");
    context.references = (dir / "shipped").string();
    context.work = (dir / "work").string();
  }
  void TearDown() override { std::filesystem::remove_all(dir); }
  ReferenceTable get() {
    return reference(
        context, set, "pair", 0.01, [&] { return t; }, result);
  }

  std::filesystem::path dir;
  ParameterSet set;
  ReferenceTable t;
  CaseContext context;
  CaseResult result;
};

TEST_F(StoredReference, IsMadeBesideTheSetAndKept) {
  EXPECT_THROW(get(), NotApplicable) << "nothing is stored";
  context.make_atoms = true;
  EXPECT_EQ(get().rows, t.rows);
  EXPECT_TRUE(std::filesystem::exists(dir / "mine-atoms/pair.csv"));
  context.make_atoms = false;
  EXPECT_EQ(get().rows, t.rows);
  EXPECT_THAT(result.sources.back(), HasSubstr("stored"));
}

TEST_F(StoredReference, IsThatOfTheSamePotentialAndLaw) {
  context.make_atoms = true;
  t.add("between_tubes", between_tubes(set));
  EXPECT_NO_THROW(get());
  context.make_atoms = false;
  set.law<LineParameters>()->universal.epsilon *= 2;
  EXPECT_THROW(get(), NotApplicable) << "another law between tubes";
  context.make_atoms = true;
  EXPECT_NO_THROW(get()) << "made anew";
  EXPECT_THAT(result.sources.back(), HasSubstr("fresh"));
  context.make_atoms = false;
  for (auto& [key, value] : set.provenance)
    if (key == "potential_hash") value = "another";
  EXPECT_THROW(get(), NotApplicable);
}

TEST_F(StoredReference, IsHeldToAFreshOne) {
  context.make_atoms = true;
  get();
  context.fresh = true;
  t.rows[1][1] = 10.5;
  EXPECT_EQ(get().rows, t.rows);
  ASSERT_EQ(result.checks.size(), 2u);
  EXPECT_TRUE(result.checks[0].holds());
  EXPECT_FALSE(result.checks[1].holds()) << "5 % off";
  EXPECT_TRUE(std::filesystem::exists(dir / "work/mine/pair.csv"));
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk::validate
