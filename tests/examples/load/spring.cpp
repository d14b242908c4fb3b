// The example of docs/how-to/load.md: [[load]] kind = "spring" pulls elements to a point, F = k (p - x).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scene/finer.hpp"
#include "scene/loads/load_kind.hpp"
#include "scene/prepare.hpp"
#include "scene/scene_toml.hpp"
#include "scene/templates.hpp"

namespace ropewalk {
namespace {

class SpringLoad : public Load {
 public:
  Vector3 point = Vector3::Zero();  // nm
  double stiffness = 0;             // eV/nm^2 for each element

  std::shared_ptr<Load> copy() const override { return std::make_shared<SpringLoad>(*this); }
  void add_forces(const State& state, double, std::vector<PointLoad>& out) const override {
    for (const int e : elements)
      out.push_back({e, stiffness * (point - state.position[static_cast<std::size_t>(e)]), Vector3::Zero()});
  }
};

void read_point(const TomlTable& t, const Scene&, SpringLoad& spring) {
  const std::vector<double> p = t.numbers("point_nm", Bounds::range(-1e6, 1e6), 3);
  spring.point = {p[0], p[1], p[2]};
}

// In mdem/scene/loads/spring.cpp this is the function that load_kind.cpp names.
LoadKind spring_kind() {
  using Key = KeyOf<SpringLoad>;
  return load_kind<SpringLoad>(
      {"spring",
       "",
       {Key::custom("point_nm", "nm", required("[0, 0, 5]"), "where it pulls to", read_point),
        Key::number("stiffness_nN_per_nm", {"nN/nm", units::nN_nm}, Bounds::positive(10), &SpringLoad::stiffness,
                    required("0.1"), "pull on each element per distance")
            .goes_as_length(1)},
       {}});
}

const bool added = add_load_kind(spring_kind());

// --- and its tests ---

using ::testing::HasSubstr;

Scene spring_scene(const std::string& load, const std::string& run) {
  return scene_of_text(
      "format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-tersoff\"\n[chain]\nelements = 21\n"
      "[contact]\nlaw = \"none\"\n[damping]\nbond_damping_per_ps = 0\n" +
          load + run,
      "spring.toml");
}

const std::string clamp = "[[load]]\nkind = \"fix\"\nelements = [0]\n";
const std::string pull =
    "[[load]]\nkind = \"spring\"\nelements = [-1]\npoint_nm = [1, 0, 13.7758708]\nstiffness_nN_per_nm = 0.02\n";

// A cantilever and a spring share the distance to the point: x = p k/(k + 3 EI/L^3).
TEST(SpringLoad, BalancesACantilever) {
  ASSERT_TRUE(added);
  Scene scene = spring_scene(clamp + pull, "[run]\nmode = \"relax\"\nforce_tolerance_nN = 1e-8\n");
  const Prepared p = prepare(scene);
  Simulation s = start(scene, p);
  ASSERT_TRUE(s.relax(scene.run.goal.force, scene.run.max_steps, [](long) { return true; }));
  const TubeType& tube = p.topology.types[0];
  const double length = 20 * tube.element_length, k = 0.02 * units::nN_nm;
  double compliance = std::pow(length, 3) / (3 * tube.bond.bend);
  if (tube.bond.shear > 0) compliance += length / tube.bond.shear;
  const double expected = k * compliance / (1 + k * compliance);
  EXPECT_GT(expected, 0.05);
  EXPECT_NEAR(s.state().position.x[20] / expected, 1, 2e-3);
}

// The work that the account has is the energy that the spring has lost.
TEST(SpringLoad, GivesTheEnergyThatItHad) {
  Scene scene = spring_scene(pull, "[run]\nduration_ps = 20\ntime_step_fs = 2\n");
  const Prepared p = prepare(scene);
  Simulation s = start(scene, p);
  const auto stored = [&] {
    const Vector3 stretched = Vector3(1, 0, 13.7758708) - s.state().position[20];
    return 0.5 * 0.02 * units::nN_nm * stretched.squaredNorm();
  };
  const double total = s.total_energy(), first = stored();
  s.steps(10000);
  EXPECT_GT(first - stored(), 0.2 * first);
  EXPECT_NEAR(s.work(), first - stored(), 1e-4 * first);
  EXPECT_NEAR(s.total_energy() - total, s.work(), 1e-4 * first);
}

TEST(SpringLoad, StaysWhereItPullsAndIsSharedWhereItPullsAtAll) {
  Scene scene = spring_scene(clamp + pull, "[run]\nduration_ps = 1\n");
  const Prepared p = prepare(scene);
  const Scene finer = scene_of_text(finer_scene_text(scene, p, "finer"), "spring.toml");
  const LoadDrive& load = *finer.drives_of<LoadDrive>().at(1);
  const auto& spring = dynamic_cast<const SpringLoad&>(*load.load);
  EXPECT_EQ(load.on.elements, (std::vector<int>{-1}));
  EXPECT_DOUBLE_EQ(spring.stiffness, 0.02 * units::nN_nm);
  EXPECT_EQ(spring.point.x(), 1);
  std::string everywhere = pull;
  everywhere.replace(everywhere.find("[-1]"), 4, "\"all\"");
  Scene all = spring_scene(clamp + everywhere, "[run]\nduration_ps = 1\n");
  const Prepared q = prepare(all);
  const Scene finer_all = scene_of_text(finer_scene_text(all, q, "finer"), "spring.toml");
  EXPECT_DOUBLE_EQ(dynamic_cast<const SpringLoad&>(*finer_all.drives_of<LoadDrive>().at(1)->load).stiffness,
                   0.01 * units::nN_nm);
}

TEST(SpringLoad, IsInHelpTemplatesAndErrors) {
  EXPECT_THAT(scene_key_help(), HasSubstr("spring: pull on each element per distance"));
  EXPECT_THAT(scene_key_help(), HasSubstr("\"fix\", \"force\", \"torque\", \"rotate\" or \"spring\""));
  EXPECT_THAT(scene_templates().front().text, HasSubstr("# stiffness_nN_per_nm = 0.1"));
  const auto message = [](const std::string& load) -> std::string {
    try {
      spring_scene(load, "[run]\nduration_ps = 1\n");
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_EQ(message("[[load]]\nkind = \"spring\"\nelements = [0]\nstiffness_nN_per_nm = 1\n"),
            "spring.toml:9: load.point_nm: is missing; add point_nm = ... below [[load]]");
  EXPECT_THAT(message(clamp + "point_nm = [0, 0, 0]\n"),
              HasSubstr("spring.toml:12: load.point_nm: belongs to kind = \"spring\", and this load is \"fix\""));
}

}  // namespace
}  // namespace ropewalk
