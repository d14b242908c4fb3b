// Correlations of the errors of a set: their table, and the covariance that follows.
#include "io/parameters_toml.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "io/files.hpp"
#include "model/error.hpp"
#include "report/page.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

using ::testing::HasSubstr;

const std::string path = ROPEWALK_SOURCE_DIR "/data/parameters/cnt-6-4-tersoff.toml";

// The shipped set, without the correlations that it may have, and with these.
std::string with(const std::string& groups) {
  ParameterSet set = read_parameters(path);
  set.correlations.clear();
  return parameters_text(set, "# changed\n") + groups;
}

constexpr const char* group = R"(
[[correlation]]
of = ["bond.EA", "bond.GJ", "atomistic.coupling"]
matrix = [[1, 0.5, 0], [0.5, 1, -0.25], [0, -0.25, 1]]
)";

TEST(Correlations, GiveTheCovariance) {
  const ParameterSet set = parameters_of_text(with(group), "set.toml");
  const double EA = *find_quantity(set, "bond.EA")->standard_error,
               GJ = *find_quantity(set, "bond.GJ")->standard_error,
               EI = *find_quantity(set, "bond.EI")->standard_error;
  const auto c = covariance(set, {"bond.GJ", "bond.EA", "bond.EI", "bond.nothing"});
  EXPECT_DOUBLE_EQ(c[0][0], GJ * GJ);
  EXPECT_DOUBLE_EQ(c[0][1], 0.5 * EA * GJ);
  EXPECT_DOUBLE_EQ(c[1][0], 0.5 * EA * GJ);
  EXPECT_DOUBLE_EQ(c[2][2], EI * EI);
  EXPECT_EQ(c[0][2], 0) << "in no group with GJ";
  EXPECT_EQ(c[3][3], 0);
}

TEST(Correlations, AreWrittenAsTheyAreRead) {
  const ParameterSet set = parameters_of_text(with(group), "set.toml");
  const ParameterSet again = parameters_of_text(parameters_text(set, ""), "set.toml");
  ASSERT_EQ(again.correlations.size(), 1u);
  EXPECT_EQ(again.correlations[0].of, set.correlations[0].of);
  EXPECT_EQ(again.correlations[0].matrix, set.correlations[0].matrix);
}

TEST(Correlations, ThatCannotBeAreRefused) {
  const auto message = [](const std::string& groups) {
    try {
      parameters_of_text(with(groups), "set.toml");
    } catch (const InputError& e) {
      return std::string(e.what());
    }
    return std::string("accepted");
  };
  const std::string head = "[[correlation]]\nof = [\"bond.EA\", \"bond.GJ\"]\nmatrix = ";
  EXPECT_THAT(message("[[correlation]]\nof = [\"bond.EB\"]\nmatrix = [[1]]\n"),
              HasSubstr("no quantity of this set"));
  EXPECT_THAT(message(head + "[[1, 0.5]]\n"), HasSubstr("2 arrays of 2 numbers"));
  EXPECT_THAT(message(head + "[[1, 0.5], [0.5]]\n"), HasSubstr("2 arrays of 2 numbers"));
  EXPECT_THAT(message(head + "[[1, 0.5], [0.4, 1]]\n"), HasSubstr("not one of correlations"));
  EXPECT_THAT(message(head + "[[2, 0.5], [0.5, 1]]\n"), HasSubstr("matrix"));
  EXPECT_THAT(message("[[correlation]]\nof = [\"bond.EA\", \"bond.GJ\", \"bond.EI\"]\n"
                      "matrix = [[1, 0.9, -0.9], [0.9, 1, 0.9], [-0.9, 0.9, 1]]\n"),
              HasSubstr("not one of correlations"));
  EXPECT_THAT(message(std::string(group) + group), HasSubstr("a second time"));
}

TEST(MeasuredText, HasAsManyDigitsAsTheErrorAllows) {
  EXPECT_EQ(measured_text(740.83567, 0.0523), "740.836 ± 0.052");
  EXPECT_EQ(measured_text(1229.66, 18.2), "1230 ± 18");
  EXPECT_EQ(measured_text(-0.0090643, 1.0e-6), "-0.0090643 ± 0.0000010");
  EXPECT_EQ(measured_text(0.34710715, 9.8e-8), "0.347107150 ± 0.000000098");
  EXPECT_EQ(measured_text(358.4, 0), "358.4");
  EXPECT_EQ(measured_text(-3.2e-13, 2.5e-8), "0 ± 2.5e-08");
  EXPECT_EQ(measured_text(1814.42, 4756), "1814 ± 4756") << "an error that exceeds a value does not hide it";
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
