// The cases of one and two tubes on their stored references: each holds, and each sees the fault that it is for.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "model/error.hpp"
#include "validate/support.hpp"

namespace ropewalk {

namespace {

using test::softer_twist;
using test::stiffer_bend;
using test::stiffer_stretch;
using test::twice_the_contact;

struct Seen {
  Case (*make)();
  Fault (*fault)();
  std::vector<Fault (*)()> unseen;     // faults of what the case does not touch
  std::set<std::string> known_misses;  // what the case's remarks discuss
};

void PrintTo(const Seen& seen, std::ostream* out) { *out << seen.make().name; }

std::set<std::string> misses(const CaseResult& result) {
  std::set<std::string> names;
  for (const Check& check : result.checks)
    if (!check.informative && !check.holds()) names.insert(check.name);
  return names;
}

class MdPairCases : public ::testing::TestWithParam<Seen> {};

TEST_P(MdPairCases, HoldOnTheirStoredReferencesButForKnownMisses) {
  const CaseResult result = test::run(GetParam().make());
  EXPECT_FALSE(result.checks.empty());
  EXPECT_EQ(misses(result), GetParam().known_misses);
}

TEST_P(MdPairCases, TurnRedUnderTheirFault) {
  const CaseResult result = test::run(GetParam().make(), GetParam().fault());
  EXPECT_FALSE(result.holds());
  EXPECT_GT(misses(result).size(), GetParam().known_misses.size());
}

TEST_P(MdPairCases, DoNotSeeFaultsOfWhatTheyDoNotTouch) {
  for (const auto fault : GetParam().unseen)
    EXPECT_EQ(misses(test::run(GetParam().make(), fault())), GetParam().known_misses);
}

TEST_P(MdPairCases, SayWhatTheyAre) {
  const Case c = GetParam().make();
  EXPECT_EQ(c.group, Case::Group::atoms);
  for (const std::string& text : {c.name, c.title, c.why, c.setup, c.oracle, c.literature})
    EXPECT_FALSE(text.empty());
  EXPECT_NE(c.literature.find("DOI"), std::string::npos);
}

TEST_P(MdPairCases, DrawFiguresAndNameTheirSources) {
  const CaseResult result = test::run(GetParam().make());
  EXPECT_GE(result.figures.size(), 2u);
  for (const CaseFigure& figure : result.figures) {
    EXPECT_TRUE(can_draw(figure.chart)) << figure.chart.title;
    EXPECT_FALSE(figure.caption.empty());
  }
  EXPECT_GE(result.sources.size(), 2u);
  EXPECT_FALSE(result.remarks.empty());
}

INSTANTIATE_TEST_SUITE_P(
    All, MdPairCases,
    ::testing::Values(Seen{tube_stretch_case, stiffer_stretch, {softer_twist, stiffer_bend, twice_the_contact}, {}},
                      Seen{tube_twist_case, softer_twist, {stiffer_stretch, stiffer_bend, twice_the_contact}, {}},
                      Seen{tube_bend_case, stiffer_bend, {stiffer_stretch, softer_twist, twice_the_contact}, {}},
                      Seen{pair_distance_case, twice_the_contact, {stiffer_stretch}, {}},
                      Seen{pair_sliding_case, twice_the_contact, {softer_twist}, {}},
                      Seen{crossed_tubes_case, twice_the_contact, {stiffer_bend}, {}}),
    [](const auto& seen) {
      std::string name = seen.param.make().name;
      std::replace(name.begin(), name.end(), '-', '_');
      return name;
    });

Check check_of(const CaseResult& result, const std::string& name) {
  for (const Check& check : result.checks)
    if (check.name == name) return check;
  throw std::out_of_range(name);
}

// The window ends before the collapse of a tube without held ends.
TEST(TwistWindow, KeepsBothTubesWithinAPerCent) {
  const CaseResult result = test::run(tube_twist_case());
  for (const char* tube : {"(5,5)", "(10,10)"})
    EXPECT_LT(std::fabs(check_of(result, std::string(tube) + ": energy in the elastic window").difference()), 0.01);
}

TEST(PaperLaw, BindsAboutTwiceAsStronglyAsTheAtoms) {
  const CaseResult result = test::run(pair_distance_case());
  const Check ratio = check_of(result, "(10,10) paper law: cohesion over that of the atoms");
  EXPECT_TRUE(ratio.informative);
  EXPECT_NEAR(ratio.value, 2.1, 0.15);
}

TEST(MdReferences, MissingOnesNameTheRemedy) {
  CaseContext context;
  context.parameters = [](const std::string& name) { return read_parameters(find_parameters(name, "")); };
  context.references = "/nowhere";
  try {
    tube_bend_case().run(context);
    FAIL() << "no reference, no error";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("--fresh"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace ropewalk
