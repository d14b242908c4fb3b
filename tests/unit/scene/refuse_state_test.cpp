// The same states are refused by whoever takes them: a scene, and the evaluation of one state.
#include "scene/refuse_state.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "io/files.hpp"
#include "scene/kinds/state.hpp"
#include "scene/prepare.hpp"
#include "scene/scene_toml.hpp"
#include "scene/single_state.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

using ::testing::HasSubstr;

constexpr double a = 1.378;  // nm, of an element

// Two tubes of three elements; the second begins `gap` (nm) above the walls' end of the first, `aside` of its axis.
// Its last element is turned about the tube.
std::string two_tubes(double gap, double aside, double turned = 0) {
  std::string text = "tube,x_nm,y_nm,z_nm,qw,qx,qy,qz\n";
  for (int tube = 0; tube < 2; ++tube)
    for (int k = 0; k < 3; ++k) {
      const double half = tube == 1 && k == 2 ? 0.5 * turned : 0;
      text += fmt::format("{},{},0,{},{},0,0,{}\n", tube, aside * tube, (3 * tube + k) * a + gap * tube,
                          std::cos(half), std::sin(half));
    }
  return text;
}

// Empty: it is taken.
struct Refusals {
  std::string alone, in_scene;
};
Refusals refusals(const std::string& state) {
  const std::string path = (std::filesystem::path(::testing::TempDir()) / "refused.csv").string();
  write_file_atomically(path, state);
  Refusals out;
  try {
    SingleState s;
    s.source = std::make_shared<StateSource>(path);
    s.parameters = {"cnt-10-10-tersoff"};
    evaluate(s);
  } catch (const InputError& e) {
    out.alone = e.what();
  }
  try {
    Scene scene =
        scene_of_text("format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-tersoff\"\n[state]\nfile = \"" +
                          path + "\"\n[run]\nduration_ps = 1\n",
                      "scene.toml");
    start(scene, prepare(scene));
  } catch (const InputError& e) {
    out.in_scene = e.what();
  }
  std::filesystem::remove(path);
  return out;
}

TEST(RefuseState, TubesInLineThatAreNoStrand) {
  const Refusals near = refusals(two_tubes(0.34, 0));
  EXPECT_THAT(near.alone, HasSubstr("refused.csv: elements 2 and 3 overlap: their axes are 0.34 nm apart"));
  EXPECT_THAT(near.alone, HasSubstr("say that they are one strand"));
  EXPECT_EQ(near.alone, near.in_scene);
  const Refusals far = refusals(two_tubes(1.5, 0));
  EXPECT_EQ(far.alone, "");
  EXPECT_EQ(far.in_scene, "");
}

TEST(RefuseState, WallsInsideOfOneAnother) {
  const Refusals inside = refusals(two_tubes(-3 * a, 0.1));
  EXPECT_THAT(inside.alone, HasSubstr("lie inside of one another"));
  EXPECT_EQ(inside.alone, inside.in_scene);
}

TEST(RefuseState, BondsThatSlip) {
  const Refusals slips = refusals(two_tubes(-3 * a, 1.7, 1.7));
  EXPECT_THAT(slips.alone, HasSubstr("the bond after element 4 is twisted by 90 degrees or more"));
  EXPECT_THAT(slips.in_scene, HasSubstr("the bond after element 4 is twisted by 90 degrees or more"));
  EXPECT_EQ(refusals(two_tubes(-3 * a, 1.7, 0.1)).alone, "");
}

TEST(RefuseState, ForcesThatAreNoNumbers) {
  Forces forces(2);
  EXPECT_NO_THROW(refuse_forces(forces, {"here", 0, ""}));
  forces.force.add(1, Vector3(0, std::nan(""), 0));
  EXPECT_THROW(refuse_forces(forces, {"here", 0, ""}), InputError);
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
