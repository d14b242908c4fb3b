// The damping of a rope of several types of tubes, and types that are the same tube.
#include "scene/dissipation.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "scene/prepare.hpp"
#include "scene/scene_toml.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

Scene scene_of_sets(const std::string& sets, const std::string& more = "") {
  return scene_of_text(fmt::format("format = \"ropewalk-scene-1\"\nparameters = {}\n{}\nelement_length_nm = 1.2\n"
                                   "[rope]\ntubes = 7\nlength_nm = 12\n[run]\nduration_ps = 1\n",
                                   sets, more),
                       "s.toml");
}

TEST(Dissipation, IsTheSameInAnyOrderOfTypes) {
  for (const char* typed : {"", "[damping]\ncontact_viscosity_eV_ps_per_nm2 = 5\n"}) {
    const auto damping = [&](const char* sets, const char* types) {
      Scene scene = scene_of_text(
          fmt::format("format = \"ropewalk-scene-1\"\nparameters = {}\ntube_types = {}\nelement_length_nm = 1.2\n"
                      "[rope]\ntubes = 7\nlength_nm = 12\n{}[run]\nduration_ps = 1\n",
                      sets, types, typed),
          "s.toml");
      return prepare(scene).interaction.damping;
    };
    const Damping one = damping("[\"cnt-10-10-tersoff\", \"cnt-5-5-tersoff\"]", "[0, 1, 0, 1, 0, 1, 0]"),
                  two = damping("[\"cnt-5-5-tersoff\", \"cnt-10-10-tersoff\"]", "[1, 0, 1, 0, 1, 0, 1]");
    EXPECT_DOUBLE_EQ(one.contact.eta, two.contact.eta);
    EXPECT_DOUBLE_EQ(one.bond.rate, two.bond.rate);
    EXPECT_DOUBLE_EQ(one.contact.inner, two.contact.inner);
  }
}

TEST(Dissipation, ASetThatIsNamedTwiceIsOneTube) {
  Scene once = scene_of_sets("\"cnt-10-10-tersoff\""),
        twice =
            scene_of_sets("[\"cnt-10-10-tersoff\", \"cnt-10-10-tersoff\"]", "tube_types = [0, 1, 0, 1, 0, 1, 0]");
  const Prepared one = prepare(once), two = prepare(twice);
  EXPECT_DOUBLE_EQ(one.interaction.damping.contact.eta, two.interaction.damping.contact.eta);
  EXPECT_DOUBLE_EQ(one.interaction.damping.bond.rate, two.interaction.damping.bond.rate);
  const Vector3 apart(1.6, 0.1, 0.3), up = Vector3::UnitZ(), aside = Vector3(0.3, 0, 1).normalized();
  EXPECT_EQ(two.interaction.law->force({0, 1}, apart, up, aside).energy,
            one.interaction.law->force({0, 0}, apart, up, aside).energy);
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
