// Loads that nothing feels, and elements that two tables move, in every pair of tables that can do so.
#include "scene/refuse_loads.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "model/error.hpp"
#include "scene/prepare.hpp"
#include "scene/scene_toml.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

using ::testing::HasSubstr;

// Why the scene is refused; empty: it is not.
std::string refused(const std::string& drives) {
  Scene scene = scene_of_text("format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-tersoff\"\n[rope]\ntubes = "
                              "7\nlength_nm = 14\n" +
                                  drives + "[run]\nduration_ps = 2\n",
                              "s.toml");
  try {
    prepare(scene);
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

std::string load(const std::string& kind, const std::string& elements, const std::string& keys = "") {
  return fmt::format("[[load]]\nkind = \"{}\"\nelements = {}\n{}", kind, elements, keys);
}
std::string fix(const std::string& elements, const std::string& keys = "") { return load("fix", elements, keys); }
std::string clamp(const std::string& end, const std::string& keys = "") {
  return fmt::format("[[grip]]\nend = \"{}\"\n{}", end, keys);
}
const std::string twist = "[twist]\nmoment_nN_nm = 2\nrate_nN_nm_per_ps = 2\n",
                  couple = load("torque", "[-1]", "torque_nN_nm = [0, 0, 2]\n"),
                  force = load("force", "[-1]", "force_nN = [1, 0, 0]\n"),
                  rotate = load("rotate", "[-1]", "rate_deg_per_ps = 1\nangle_deg = 1\n");

TEST(RefuseLoads, NamesLoadsThatNothingFeels) {
  for (const std::string& unfelt :
       {twist + fix("\"ends\""), twist + "application = \"tangential\"\n" + fix("\"ends\""), couple + fix("[-1, 0]"),
        force + fix("[-1]", "axes = \"x\"\nrotation = false\n"), couple + clamp("upper"), force + clamp("both"),
        force + rotate, couple + rotate})
    EXPECT_THAT(refused(unfelt), HasSubstr("nothing feels")) << unfelt;
}

TEST(RefuseLoads, LetsStandWhatActsOnSomething) {
  for (const std::string& felt :
       {twist, twist + fix("[0]"), twist + fix("\"ends\"", "axes = \"z\"\nrotation = false\n"),
        twist + "application = \"tangential\"\n" + fix("\"ends\"", "axes = \"x\"\nrotation = false\n"),
        couple + fix("[-1]", "axes = \"xyz\"\nrotation = false\n"), force + fix("[-1]", "axes = \"yz\"\n"),
        couple + clamp("upper", "about_z = \"free\"\n"), couple + clamp("upper", "spin_free = true\n"),
        couple + rotate + "spin_free = true\n", force + clamp("lower"),
        force + clamp("upper", "tubes = [0, 3]\n"), fix("[0]") + rotate})
    EXPECT_EQ(refused(felt), "") << felt;
}

TEST(RefuseLoads, NamesElementsThatAClampAndALoadMove) {
  const std::string pulled = "z = { displacement_nm = [[0, 0], [1, 0.1]] }\n";
  for (const std::string& twice :
       {clamp("upper", pulled) + fix("[-1]"), clamp("upper") + rotate,
        fix("\"all\"") + clamp("lower", "about_z = { rotation_deg = [[0, 0], [1, 1]] }\n")})
    EXPECT_THAT(refused(twice), HasSubstr("a [[grip]] does as well")) << twice;
  // Both hold the same.
  for (const std::string& once : {clamp("upper") + fix("[-1]"), clamp("upper", pulled) + fix("\"all\"", "axes = \"xy\"\n")})
    EXPECT_EQ(refused(once), "") << once;
  EXPECT_EQ(refused(clamp("upper", "tubes = [0]\n") + load("fix", "[-1]", "tubes = [1, 2]\n")), "");
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
