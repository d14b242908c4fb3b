// What force terms take out of the motion, held to the law of friction by hand.
#include "scene/term_damping.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "scene/prepare.hpp"
#include "scene/scene_toml.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

// By hand: 12 contacts of 7 tubes. With the distance w of the axes and I = m r^2 the rate of the slip along them
// has the mean square kT/m (2 + w^2/2 r^2), that of the slip by spin kT/m (2 + 8 r^2/w^2).
TEST(TermDamping, IsMeasured) {
  const double drag = 0.4;
  const auto prepared = [](const std::string& friction) {
    Scene scene = scene_of_text(
        "format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-tersoff\"\n[rope]\ntubes = 7\nlength_nm = 27.6\n" +
            friction + "[run]\nduration_ps = 1\n",
        "scene.toml");
    return prepare(scene);
  };
  const auto measured = [](const Prepared& p) { return damping_of_terms(p.topology, p.interaction, p.state, 300); };
  const std::string strength = "[[friction]]\nstrength_pN_per_nm = 10\nspin_strength_pN_per_nm = 10\n";
  const Prepared p = prepared(strength + fmt::format("drag_eV_ps_per_nm3 = {}\n", drag));
  const std::vector<TermDamping> braked = measured(p);
  ASSERT_EQ(braked.size(), 1u);
  EXPECT_EQ(braked[0].name, "friction");
  const TubeType& type = p.topology.types[0];
  const double ratio = std::pow(p.spacing / type.radius, 2),
               expected = drag * type.element_length * 12 / 7 * (4 + 0.5 * ratio + 8 / ratio) / type.mass / 6;
  EXPECT_NEAR(braked[0].rate, expected, 0.1 * expected);
  EXPECT_TRUE(measured(prepared(strength)).empty());
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
