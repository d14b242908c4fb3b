// The notes on a scene that are printed before its first step.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "plan/forecast.hpp"
#include "run/run_directory.hpp"
#include "scene/prepare.hpp"
#include "scene/scene_toml.hpp"
#include "unit/support.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

std::vector<std::string> warnings_for(const std::string& drives, double tilt_deg) {
  Scene scene = scene_of_text("format = \"ropewalk-scene-1\"\nparameters = \"cnt-5-5-tersoff\"\n[rope]\ntubes = 7\n"
                              "length_nm = 8\n" +
                                  drives + "[run]\nduration_ps = 1\n",
                              "s.toml");
  Prepared p = prepare(scene);
  const Quaternion turn = test::turn(Vector3(0, 1, 0), tilt_deg * units::degree);
  for (std::size_t i = 0; i < p.state.size(); ++i) {
    p.state.position.set(i, turn * Vector3(p.state.position[i]));
    p.state.orientation.set(i, (turn * p.state.orientation[i]).normalized());
  }
  return warnings_of(scene, p);
}

TEST(SceneNotes, ARopeThatLeansIsNotDrivenAboutItsAxis) {
  const std::string turned = "[[grip]]\nend = \"lower\"\n[[grip]]\nend = \"upper\"\nabout_z = { rotation_deg = [[0, 0], "
                             "[20, 20]] }\n",
                    wound = "[twist]\nmoment_nN_nm = 1\nrate_nN_nm_per_ps = 1\n";
  EXPECT_THAT(warnings_for(turned, 10), Contains(HasSubstr("The axis of the rope stands at 10 degrees to z. [grip] "
                                                           "acts along and about z, not along and about this")));
  EXPECT_THAT(warnings_for(wound, 10), Contains(HasSubstr("[twist] acts")));
  for (const std::string& drives : {turned, wound})
    EXPECT_THAT(warnings_for(drives, 0.2), Not(Contains(HasSubstr("The axis of the rope"))));
  EXPECT_THAT(warnings_for("", 10), Not(Contains(HasSubstr("The axis of the rope"))));
}

// Tubes with ends slide in a twisted slice: their walls do not turn with it, they are not strained by it, and it opens.
TEST(SceneNotes, ASliceOfShortTubesThatIsTwistedFarOpens) {
  const auto said = [](const std::string& rope, double turns) {
    Scene scene = scene_of_text(
        fmt::format("format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-tersoff\"\n[rope]\ntubes = 19\nlength_nm = "
                    "148\n{}[periodic]\nturns_per_m = [[0, 0], [200, {}]]\nyarn_diameter_um = 15\ntension_nN = [[0, "
                    "0]]\n[run]\nduration_ps = 200\n",
                    rope, turns),
        "s.toml");
    const Prepared p = prepare(scene);
    std::string all;
    for (const std::string& note : warnings_of(scene, p)) all += note + "\n";
    for (const std::string& note : limits_ahead(scene, p)) all += note + "\n";
    return all;
  };
  const std::string short_tubes = "tube_length_nm = 40\n";
  EXPECT_THAT(said(short_tubes, 12000), HasSubstr("at 29.5 degrees at its surface it may open"));
  EXPECT_THAT(said(short_tubes, 4000), Not(HasSubstr("it may open")));
  EXPECT_THAT(said(short_tubes, 4000), Not(HasSubstr("wall_twist")));
  EXPECT_THAT(said("", 12000), Not(HasSubstr("it may open")));
  EXPECT_THAT(said("", 4000), HasSubstr("wall_twist"));
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
