// What is said of a scene before its first step.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

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
  EXPECT_THAT(warnings_for(turned, 10), Contains(HasSubstr("The axis of the rope stands at 10 degrees to z, and along "
                                                           "and about z, not about the axis of the rope, [grip]")));
  EXPECT_THAT(warnings_for(wound, 10), Contains(HasSubstr("[twist] acts")));
  for (const std::string& drives : {turned, wound})
    EXPECT_THAT(warnings_for(drives, 0.2), Not(Contains(HasSubstr("The axis of the rope"))));
  EXPECT_THAT(warnings_for("", 10), Not(Contains(HasSubstr("The axis of the rope"))));
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
