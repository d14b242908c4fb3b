// Which scene an expectation holds for.
#include "scene/expectation.hpp"

#include <gtest/gtest.h>

#include "scene/scene_toml.hpp"
#include "scene/templates.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

TEST(SceneHash, IsOfWhatIsRun) {
  const std::string text = "name = \"a\"\n[rope]\ntubes = 7\nlength_nm = 14\n[run]\nduration_ps = 5\n",
                    hash = what_is_run_hash(text);
  EXPECT_EQ(what_is_run_hash(
                "# why\n[run]\nduration_ps = 5.0 # ps\nframes_every_ps = 1\n[rope]\nlength_nm = 14.0\ntubes = "
                "7\n[[expect]]\ncolumn = \"Q\"\n"),
            hash);
  for (const char* other : {"name = \"a\"\n[rope]\ntubes = 19\nlength_nm = 14\n[run]\nduration_ps = 5\n",
                            "name = \"a\"\n[rope]\ntubes = 7\nlength_nm = 14\n[run]\nduration_ps = 5\n[twist]\n"
                            "axial = \"held\"\n"})
    EXPECT_NE(what_is_run_hash(other), hash) << other;
}

// A template expects what it gave. Changed, it expects nothing.
TEST(SceneHash, OfATemplateEndsWithItsFirstChange) {
  int expecting = 0;
  for (const SceneTemplate& t : scene_templates()) {
    const Scene scene = scene_of_text(t.text, ROPEWALK_SOURCE_DIR "/data/scenes/t.toml"),
                changed = scene_of_text(t.text + "\n[[stop]]\nwhen = \"limit\"\n",
                                        ROPEWALK_SOURCE_DIR "/data/scenes/t.toml");
    ASSERT_EQ(scene.expected.size(), changed.expected.size());
    for (std::size_t k = 0; k < scene.expected.size(); ++k, ++expecting) {
      EXPECT_FALSE(scene.expected[k].of_other_scene) << t.name;
      EXPECT_TRUE(changed.expected[k].of_other_scene) << t.name;
    }
    EXPECT_EQ(t.brief.find("expect"), std::string::npos) << t.name;
  }
  EXPECT_GT(expecting, 0);
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
