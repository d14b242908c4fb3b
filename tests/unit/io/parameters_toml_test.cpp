// Correlations of the errors of a set: their table, and the covariance that follows.
#include "io/parameters_toml.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
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

TEST(PullOfASet, IsWrittenAsItIsRead) {
  const ParameterSet set = read_parameters(path), again = parameters_of_text(parameters_text(set, ""), "set.toml");
  ASSERT_TRUE(set.pull && again.pull);
  EXPECT_EQ(set.pull->end, again.pull->end);
  EXPECT_EQ(set.end_of_stretch(), set.pull->end);
  for (std::size_t k = 0; k <= PULL_STEPS; ++k)
    EXPECT_NEAR(set.pull->force[k], again.pull->force[k], 1e-6 * set.pull->force[k]) << k;
  ParameterSet without = set;
  const auto begin = std::find_if(without.quantities.begin(), without.quantities.end(),
                                  [](const Quantity& q) { return q.key == "bond.pull.end"; });
  ASSERT_NE(begin, without.quantities.end());
  without.quantities.erase(begin);
  const ParameterSet old = parameters_of_text(parameters_text(without, ""), "set.toml");
  EXPECT_FALSE(old.pull);
  EXPECT_EQ(old.end_of_stretch(), old.anharmonic->max_strain);
}

TEST(PullOfASet, ThatCannotBeIsRefused) {
  const auto message = [](const std::function<void(ParameterSet&)>& change) {
    ParameterSet set = read_parameters(path);
    change(set);
    try {
      parameters_of_text(parameters_text(set, ""), "set.toml");
    } catch (const InputError& e) {
      return std::string(e.what());
    }
    return std::string("accepted");
  };
  const auto put_end = [](ParameterSet& set, double end) {
    for (Quantity& q : set.quantities)
      if (q.key == "bond.pull.end") q.value = end;
  };
  EXPECT_EQ(message([](ParameterSet&) {}), "accepted");
  EXPECT_THAT(message([](ParameterSet& s) { s.pull->force[5] = s.pull->force[4]; }),
              HasSubstr("bond.pull.force: does not rise from value 4 to value 5"));
  EXPECT_THAT(message([](ParameterSet& s) { s.pull->force[0] *= 1.2; }), HasSubstr("calibrate the set anew"));
  EXPECT_THAT(message([&](ParameterSet& s) { put_end(s, 0.01); }), HasSubstr("bond.pull.end"));
  EXPECT_THAT(message([&](ParameterSet& s) { put_end(s, 0.9); }), HasSubstr("rises too little"));
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
