// The same scene done more slowly.
#include "scene/slower.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scene/prepare.hpp"
#include "scene/scene_keys.hpp"
#include "scene/scene_toml.hpp"
#include "sim/dynamics/end_drives.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

using ::testing::HasSubstr;
using ::testing::UnorderedElementsAre;

struct Pair {
  Scene scene, slower;
  Prepared before, after;

  explicit Pair(const std::string& body)
      : scene(
            scene_of_text("format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-tersoff\"\n" + body, "s.toml")),
        slower(scene_of_text(slower_scene_text(scene, 2, "why"), "s.toml")),
        before(prepare(scene)),
        after(prepare(slower)) {}
};

const std::string seven = "[rope]\ntubes = 7\nlength_nm = 14\n";

// Every component of every end does at twice the time what it did before.
void expect_half_as_fast(const Pair& p) {
  EXPECT_EQ(why_not_slower(p.scene), "");
  EXPECT_NEAR(p.after.duration, 2 * p.before.duration, 1e-9 * p.before.duration);
  const EndDrives a = end_drives(p.before.loads, p.before.topology),
                  b = end_drives(p.after.loads, p.after.topology);
  ASSERT_EQ(a.size(), b.size());
  int driven = 0;
  for (std::size_t k = 0; k < a.size(); ++k)
    for (std::size_t axis = 0; axis < 6; ++axis) {
      const LoadComponent &before = a[k].does.axes[axis], &after = b[k].does.axes[axis];
      if (!before.now) continue;
      ++driven;
      for (double t = 0.05; t < p.before.duration; t += 0.1 * p.before.duration)
        EXPECT_NEAR(after.course.value(2 * t), before.course.value(t), 1e-9 * before.course.largest()) << axis;
    }
  EXPECT_GT(driven, 0);
}

TEST(SlowerScene, DoesAtTwiceTheTimeWhatItDid) {
  expect_half_as_fast(Pair(seven + "[twist]\nmoment_nN_nm = 2\nrate_nN_nm_per_ps = 0.5\nhold_ps = 3\n"
                                   "unload_rate_nN_nm_per_ps = 1\nunloaded_ps = 4\n"));
  expect_half_as_fast(Pair(seven + "[[grip]]\nend = \"lower\"\n[[grip]]\nend = \"upper\"\n"
                                   "z = { displacement_nm = [1, 0.5], rate_nm_per_ps = 0.25 }\n"
                                   "about_z = { rotation_deg = [[0, 0], [4, 30], [6, 10]] }\n"));
  expect_half_as_fast(Pair(
      seven + "[[grip]]\nend = \"lower\"\n[[grip]]\nend = \"upper\"\nz = { force_nN = 3, rate_nN_per_ps = 1 }\n"));
  expect_half_as_fast(
      Pair("[chain]\nelements = 9\n[[load]]\nkind = \"fix\"\nelements = [0]\n[[load]]\nkind = \"rotate\"\n"
           "elements = [-1]\nrate_deg_per_ps = 2\nangle_deg = 8\n[run]\nduration_ps = 6\n"));
}

TEST(SlowerScene, ReachesWhatDrivesNoEnd) {
  const Pair warm(seven +
                  "[start]\ntemperature_K = 100\n[thermostat]\ntemperature_K = [[0, 100], [10, 300]]\n"
                  "coupling_per_ps = 0.1\n[damping]\ncontact_viscosity_eV_ps_per_nm3 = 0\nbond_damping_per_ps = 0\n"
                  "[run]\nduration_ps = 20\nlog_every_ps = 0.5\n");
  EXPECT_NEAR(warm.slower.bath()->temperature.value(12), warm.scene.bath()->temperature.value(6), 1e-9);
  EXPECT_EQ(warm.slower.bath()->coupling, warm.scene.bath()->coupling) << "what tubes do by themselves stays";
  EXPECT_EQ(warm.slower.run.log_every, 1);
  const Pair yarn(
      seven +
      "[periodic]\ntwist_deg_per_nm = [[0, 0], [5, 1]]\ntension_nN = [[0, 1]]\nstrain = [[6, 0], [8, "
      "0.01]]\n[[links]]\nper_nm = 0.1\nplaced_at_ps = 5\nstiffness_nN_per_nm = 100\n[run]\nduration_ps = 8\n"
      "[[stop]]\nwhen = \"above\"\ncolumn = \"time_ps\"\nvalue = 100\nfrom_ps = 7\n"
      "[[expect]]\ncolumn = \"time_ps\"\nvalue = 7\ntolerance = 1\nat_ps = 7\n");
  const std::string text = slower_scene_text(yarn.scene, 2, "why");
  EXPECT_THAT(text, HasSubstr("# why"));
  EXPECT_EQ(yarn.after.duration, 16);
  EXPECT_EQ(yarn.slower.stops.front().from, 14);
  EXPECT_EQ(*yarn.slower.expected.front().at, 14);
  EXPECT_THAT(text, HasSubstr("placed_at_ps = 10.0"));
  for (const auto& drive : yarn.slower.drives) {
    if (drive->table().name == "periodic") {
      EXPECT_THAT(drive->words(), HasSubstr("in 10 ps"));
    }
  }
}

TEST(SlowerScene, IsNoneWhereNothingHasARate) {
  const auto why = [](const std::string& body) {
    return why_not_slower(
        scene_of_text("format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-tersoff\"\n" + body, "s.toml"));
  };
  EXPECT_EQ(why(seven + "[twist]\nmoment_nN_nm = 2\nrate_nN_nm_per_ps = 0\nhold_ps = 9\n"),
            "nothing in the scene is moved or loaded at a rate");
  EXPECT_EQ(why(seven + "[thermostat]\ntemperature_K = 300\ncoupling_per_ps = 1\n[run]\nduration_ps = 9\n"),
            "nothing in the scene is moved or loaded at a rate");
  EXPECT_EQ(why(seven + "[run]\nmode = \"relax\"\n"), "a relaxation has no rate");
}

// A new key with ps in its unit must say whether it goes with the pace of what is done to the scene.
TEST(SlowerScene, KnowsThePaceOfEveryKeyWithATime) {
  std::vector<std::string> without;
  for (const SceneKey& key : scene_keys())
    if (key.unit.find("ps") != std::string::npos && key.pace == SceneKey::Pace::none)
      without.push_back(key.table + "." + key.key);
  EXPECT_THAT(without, UnorderedElementsAre("damping.contact_viscosity_eV_ps_per_nm3",
                                            "damping.bond_damping_per_ps", "thermostat.coupling_per_ps",
                                            "twist.increment_ps", "friction.drag_eV_ps_per_nm3",
                                            "links.forming_per_nm_ps", "limits.speed_nm_per_ps"));
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
