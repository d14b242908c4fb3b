// Facts about one and two tubes of atoms beyond the verdicts of their cases, and a missing reference.
#include <gtest/gtest.h>

#include <string>

#include "runner/runner.hpp"
#include "validate/support.hpp"

namespace ropewalk {
namespace {

using test::check_of;

TEST(PaperLaw, BindsAboutTwiceAsStronglyAsTheAtoms) {
  const CaseResult result = test::run(find_case("pair-distance"));
  const Check& ratio = check_of(result, "(10,10) paper law: cohesion over that of the atoms");
  EXPECT_TRUE(ratio.informative);
  EXPECT_NEAR(ratio.value, 2.1, 0.15);
}

TEST(MissingReference, IsNotApplicableAndSaysWhatToDo) {
  CaseContext context = test::stored_context();
  context.references = "/nowhere";
  context.sets = {test::shipped("cnt-5-5-tersoff")};
  try {
    find_case("tube-bend").run(context);
    FAIL() << "no reference, no error";
  } catch (const NotApplicable& reason) {
    EXPECT_NE(std::string(reason.what()).find("--atoms"), std::string::npos) << reason.what();
  }
}

}  // namespace
}  // namespace ropewalk
