// What a scene expects of its run: run/expectations.hpp and [[expect]].
#include "run/expectations.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "model/error.hpp"
#include "scene/prepare.hpp"
#include "scene/scene_toml.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

using ::testing::HasSubstr;

LogRow row_at(double time, double twist) {
  LogRow row;
  row["time_ps"] = time;
  row["geometric_twist_deg"] = twist;
  row["tension_upper_nN"] = std::nan("");
  return row;
}

Scene scene_with(const std::string& tables) {
  return scene_of_text(
      "format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-tersoff\"\n[rope]\ntubes = 1\nlength_nm = "
      "11\n[run]\nduration_ps = 4\n" +
          tables,
      "s.toml", {});
}

std::string refusal_of(const std::string& tables) {
  try {
    Scene scene = scene_with(tables);
    (void)prepare(scene);
  } catch (const InputError& e) {
    return e.what();
  }
  return "taken";
}

TEST(Expectations, AreJudgedAtTheirTimeAndAtTheEnd) {
  const std::vector<LogRow> rows = {row_at(0, 0), row_at(2, 10), row_at(4, 12)};
  const auto holds = [&](std::optional<double> at, double value, double tolerance) {
    return judge({{"geometric_twist_deg", at, value, tolerance, ""}}, rows).front().holds;
  };
  EXPECT_TRUE(holds({}, 12.4, 0.5));
  EXPECT_FALSE(holds({}, 12.6, 0.5));
  EXPECT_FALSE(holds({}, 11.4, 0.5));
  EXPECT_TRUE(holds(1, 5, 1e-9)) << "between two rows";
  EXPECT_TRUE(holds(2, 10, 1e-9));
  EXPECT_TRUE(holds(4.1, 12, 1)) << "whole steps end a little before";
  EXPECT_FALSE(holds(7, 12, 1)) << "no row is there";
  EXPECT_FALSE(judge({{"tension_upper_nN", {}, 0, 1e12, ""}}, rows).front().holds) << "it has no value";
  EXPECT_FALSE(judge({{"geometric_twist_deg", {}, 0, 1e12, ""}}, std::vector<LogRow>()).front().holds)
      << "no row at all";
  const std::vector<Judgement> all =
      judge({{"geometric_twist_deg", {}, 12, 1, ""}, {"geometric_twist_deg", 2, 12, 1, ""}}, rows);
  EXPECT_EQ(missed(all), 1);
  EXPECT_EQ(all[0].words, "geometric_twist_deg is 12 at the end, as expected: 12 ± 1");
  EXPECT_EQ(all[1].words, "geometric_twist_deg is 10 at 2 ps, not as expected: 12 ± 1");
}

TEST(Expectations, AreReadFromAScene) {
  const Scene scene = scene_with(
      "[[expect]]\ncolumn = \"geometric_twist_deg\"\nvalue = -5\ntolerance_percent = 2\n[[expect]]\ncolumn = "
      "\"time_ps\"\nvalue = 4\ntolerance = 0.1\nat_ps = 3\n");
  ASSERT_EQ(scene.expected.size(), 2u);
  EXPECT_DOUBLE_EQ(scene.expected[0].tolerance, 0.1);
  EXPECT_FALSE(scene.expected[0].at);
  EXPECT_EQ(scene.expected[1].at, 3);
}

TEST(Expectations, ThatCannotBeJudgedAreRefused) {
  const std::string one = "[[expect]]\ncolumn = \"geometric_twist_deg\"\nvalue = 5\n";
  EXPECT_THAT(refusal_of(one), HasSubstr("tolerance: is missing"));
  EXPECT_THAT(refusal_of(one + "tolerance = 1\ntolerance_percent = 1\n"), HasSubstr("are both given"));
  EXPECT_THAT(refusal_of(one + "tolerance = 0\n"), HasSubstr("tolerance"));
  EXPECT_THAT(refusal_of("[[expect]]\ncolumn = \"geometric_twist_deg\"\nvalue = 0\ntolerance_percent = 1\n"),
              HasSubstr("that is 0"));
  EXPECT_THAT(refusal_of("[[expect]]\ncolumn = \"twist\"\nvalue = 1\ntolerance = 1\n"), HasSubstr("has no column"));
  EXPECT_THAT(refusal_of(one + "tolerance = 1\nat_ps = 9\n"), HasSubstr("the run ends at 4 ps"));
  EXPECT_EQ(refusal_of(one + "tolerance = 1\nat_ps = 4\n"), "taken");
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
