// What is known about one and two tubes of atoms beyond the verdicts of their cases, and a missing reference.
#include <gtest/gtest.h>

#include <string>

#include "model/error.hpp"
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

TEST(MissingReference, IsReportedWithTheRemedy) {
  CaseContext context = test::stored_context();
  context.references = "/nowhere";
  try {
    find_case("tube-bend").run(context);
    FAIL() << "no reference, no error";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("--fresh"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace ropewalk
