// What `errors` varies in a scene, and what it names.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "campaign/error_runs.hpp"
#include "model/error.hpp"
#include "scene/scene_toml.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsSupersetOf;

std::vector<std::string> names(const ErrorInputs& inputs) {
  std::vector<std::string> all;
  for (const VariedNumber& v : inputs.varied) all.push_back(v.error.name);
  return all;
}

ErrorInputs inputs_of(const std::string& parameters, const std::string& more) {
  const Scene scene = scene_of_text("format = \"ropewalk-scene-1\"\nparameters = " + parameters +
                                        "\n[rope]\ntubes = 7\nlength_nm = 7\n" + more + "[run]\nduration_ps = 1\n",
                                    "s.toml");
  return error_inputs(scene, 7);
}

TEST(ErrorInputs, AreAllThatHaveAnError) {
  const ErrorInputs plain = inputs_of("\"cnt-10-10-tersoff\"", "[bond]\nlaw = \"harmonic\"\n");
  EXPECT_EQ(names(plain), (std::vector<std::string>{"EA", "EI", "GJ", "contact"}));
  const ErrorInputs rich = inputs_of("\"cnt-10-10-tersoff\"",
                                     "[[friction]]\nfrom = \"atoms\"\n[failure]\nstrain = { value = 0.05, "
                                     "standard_error = 0.01 }\nmoment_nN_nm = 15\n");
  EXPECT_THAT(names(rich),
              IsSupersetOf({"e3", "es2", "e4", "s4", "b4", "friction.strength", "friction.spin_strength",
                            "friction.end_strength", "friction.elastic_slip", "failure.strain"}));
  EXPECT_THAT(rich.without_error, Contains("failure.moment_nN_nm = 15"));
  EXPECT_THAT(rich.without_error, Contains(HasSubstr("damping.contact_viscosity")));
  for (const VariedNumber& v : rich.varied) {
    EXPECT_GT(v.error.sigma, 0) << v.error.name;
    EXPECT_LE(v.error.step, 0.9) << v.error.name;
    EXPECT_EQ(std::count_if(rich.varied.begin(), rich.varied.end(),
                            [&](const VariedNumber& other) { return other.error.plus == v.error.plus; }),
              1)
        << v.error.plus;
  }
}

// Friction files of three pairs, and the contact of unlike tubes.
TEST(ErrorInputs, OfTwoKindsOfTubesAreThoseOfAllPairs) {
  const ErrorInputs inputs =
      inputs_of("[\"cnt-5-5-tersoff\", \"cnt-9-0-tersoff\"]\ntube_types = [0, 1, 0, 1, 0, 1, 0]",
                "[[friction]]\nfrom = \"atoms\"\n");
  EXPECT_THAT(names(inputs),
              IsSupersetOf({"EA of cnt-5-5-tersoff", "EA of cnt-9-0-tersoff", "contact of unlike tubes",
                            "friction.strength of file 0", "friction.strength of file 2"}));
  // (5,5) beside (5,5) have no strength at their ends, within an error: it can only be larger.
  const auto ends = std::find_if(inputs.varied.begin(), inputs.varied.end(), [](const VariedNumber& v) {
    return v.error.name == "friction.end_strength of file 0";
  });
  ASSERT_NE(ends, inputs.varied.end());
  EXPECT_TRUE(ends->error.minus.empty());
  EXPECT_GT(ends->error.sigma, 0);
}

TEST(ErrorInputs, OfAPublishedSetAreNamed) {
  try {
    inputs_of("\"cnt-10-10-paper\"", "");
    FAIL();
  } catch (const InputError& e) {
    EXPECT_THAT(e.what(), HasSubstr("take a calibrated set"));
  }
  const ErrorInputs one =
      inputs_of("\"cnt-10-10-paper\"", "[damping]\nbond_damping_per_ps = { value = 5, standard_error = 1 }\n");
  EXPECT_EQ(names(one), std::vector<std::string>{"damping.bond_damping_per_ps"});
  EXPECT_THAT(one.without_error, Contains("EA, EI, GJ, contact of cnt-10-10-paper"));
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
