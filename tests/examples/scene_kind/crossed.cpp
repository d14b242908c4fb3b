// The example of docs/how-to/scene-kind.md: [crossed] is two tubes that cross at their middles.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "scene/finer.hpp"
#include "scene/kinds/scene_kind.hpp"
#include "scene/lattice.hpp"
#include "scene/prepare.hpp"
#include "scene/scene_toml.hpp"
#include "scene/spacing.hpp"
#include "scene/templates.hpp"
#include "sim/contact/line/law.hpp"
#include "sim/dynamics/refine.hpp"

namespace ropewalk {
namespace {

// One tube along z, the other one above it in x and turned about x.
class CrossedSource : public Source {
 public:
  double length = 0;               // nm, rounded to whole elements
  double angle = 0.5 * units::pi;  // rad
  double distance = 0;             // nm, of the axes; 0: where they bind best at a right angle

  Sizes sizes(double element_length) const override { return {2, whole_elements(length, element_length)}; }
  void place(const Scene& scene, double, Random&, Topology& topology, State& state) const override {
    const int elements = sizes(scene.element_length).elements;
    add_straight_tubes({{0, 0}, {distance > 0 ? distance : crossed_spacing(scene), 0}}, elements,
                       scene.element_length, topology, state);
    const Quaternion turn(Eigen::AngleAxisd(angle, Vector3::UnitX()));
    for (int e = elements; e < 2 * elements; ++e) {
      const auto i = static_cast<std::size_t>(e);
      state.position.set(i, turn * state.position[i]);
      state.orientation.set(i, turn);
    }
  }
  std::string description(const Topology&, const State&, double) const override {
    return fmt::format("two tubes that cross at {:.4g} deg", angle / units::degree);
  }
};

void check(const TomlTable& t, const Scene& scene, CrossedSource& crossed) {
  const int elements = crossed.sizes(scene.element_length).elements;
  if (elements < 2) throw t.error("length_nm", "makes fewer than two elements", "take longer tubes");
  check_size(t, "length_nm", 2, elements);
}

// In mdem/scene/kinds/crossed.cpp this is the function that scene_kind.cpp names.
SceneKind crossed_kind() {
  using Key = KeyOf<CrossedSource>;
  return scene_kind<CrossedSource>(
      {"crossed",
       "instead of [rope]: two tubes that cross at their middles",
       {Key::number("length_nm", unit::nm, Bounds::positive(1e6), &CrossedSource::length, required("20"),
                    "length of the tubes, rounded to whole elements")
            .is_tube_size(SceneKey::TubeSize::length),
        Key::number("angle_deg", unit::degree, Bounds::range(1, 179), &CrossedSource::angle, standard(),
                    "between the tubes"),
        Key::number("distance_nm", unit::nm, spacing_bounds, &CrossedSource::distance,
                    otherwise("1.7", "where two crossed tubes bind best"), "of the tube axes")},
       check});
}

const bool added = add_scene_kind(crossed_kind());

// --- and its tests ---

using ::testing::HasSubstr;

Scene crossed_scene(const std::string& keys) {
  return scene_of_text("format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-tersoff\"\n[crossed]\n" + keys +
                           "[run]\nduration_ps = 1\n",
                       "crossed.toml");
}

// One tube above the other binds as two tubes of the law do where they cross: the ends are far away.
TEST(CrossedKind, BindsAsTheLawSays) {
  ASSERT_TRUE(added);
  for (const double angle : {90.0, 60.0}) {
    Scene scene = crossed_scene(fmt::format("length_nm = 27.6\nangle_deg = {}\ndistance_nm = 1.7\n", angle));
    const Prepared p = prepare(scene);
    ASSERT_EQ(p.topology.tubes(), 2);
    EXPECT_EQ(p.topology.length_of(1), 20);
    EXPECT_NEAR(axis_of(p.state.orientation[0]).dot(axis_of(p.state.orientation[25])),
                std::cos(angle * units::degree), 1e-12);
    const Energies e = start(scene, p).forces().energy;
    EXPECT_NEAR(e.bonds(), 0, 1e-12);
    const double law = line_crossed_energy(dynamic_cast<const LineLaw&>(*p.interaction.law).pairs.front().density,
                                           1.7, angle * units::degree);
    EXPECT_LT(law, -1);
    EXPECT_NEAR(e.vdw / law, 1, 0.01);
  }
}

TEST(CrossedKind, LiesWhereItBindsBest) {
  Scene scene = crossed_scene("length_nm = 27.6\n");
  const Prepared p = prepare(scene);
  EXPECT_DOUBLE_EQ(p.state.position.x[20], crossed_spacing(scene));
  EXPECT_EQ(scene.source->description(p.topology, p.state, p.spacing), "two tubes that cross at 90 deg");
}

TEST(CrossedKind, IsRefinedByItsKeys) {
  Scene scene = crossed_scene("length_nm = 27\nangle_deg = 45\n");
  const Prepared p = prepare(scene);
  Scene finer = scene_of_text(finer_scene_text(scene, p, "finer"), "crossed.toml");
  EXPECT_EQ(prepare(finer).topology.tube_begin, halved(p.topology).tube_begin);
}

TEST(CrossedKind, IsInHelpTemplatesAndErrors) {
  EXPECT_THAT(scene_key_help(), HasSubstr("[crossed]  instead of [rope]: two tubes that cross at their middles"));
  EXPECT_THAT(scene_templates().front().text, HasSubstr("# [crossed]\n# length_nm = 20"));
  const auto message = [](const std::string& keys) -> std::string {
    try {
      crossed_scene(keys);
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_EQ(message("length_nm = 1\n"),
            "crossed.toml:4: crossed.length_nm: makes fewer than two elements; take longer tubes");
  EXPECT_THAT(message("length_nm = 20\n[chain]\nelements = 5\n"),
              HasSubstr("a scene has exactly one of [rope], [plies], [film], [chain], [state] and [crossed]"));
}

}  // namespace
}  // namespace ropewalk
