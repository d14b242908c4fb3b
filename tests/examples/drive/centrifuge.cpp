// The example of docs/how-to/drive.md: [centrifuge] drives all elements away from the z axis, F = m w^2 r.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "scene/finer.hpp"
#include "scene/key_table.hpp"
#include "scene/drive_kind.hpp"
#include "scene/prepare.hpp"
#include "scene/scene_toml.hpp"
#include "scene/templates.hpp"

namespace ropewalk {
namespace {

class CentrifugeLoad : public Load {
 public:
  double rate = 0;           // rad/ps
  std::vector<double> mass;  // of the elements

  std::shared_ptr<Load> copy() const override { return std::make_shared<CentrifugeLoad>(*this); }
  void add_forces(const State& state, double, std::vector<PointLoad>& out) const override {
    for (std::size_t k = 0; k < elements.size(); ++k) {
      const Vector3 x = state.position[static_cast<std::size_t>(elements[k])];
      out.push_back({elements[k], mass[k] * rate * rate * Vector3(x.x(), x.y(), 0), Vector3::Zero()});
    }
  }
  // For a rank of LAMMPS, which has some of the elements.
  void keep(const std::vector<std::size_t>& places, const LoadProcesses& others) override {
    mass = chosen(mass, places);
    Load::keep(places, others);
  }
};

class CentrifugeDrive : public Drive {
 public:
  double rate = 0;  // rad/ps

  static const KeyTable<CentrifugeDrive>& keys();
  SceneTable table() const override { return keys().doc(); }
  std::string words() const override { return fmt::format("centrifuge: {:.4g} deg/ps", rate / units::degree); }
  void add_loads(const Scene&, const Topology& topology, const Interaction&,
                 LoadsAndConstraints& loads) const override {
    CentrifugeLoad load;
    load.rate = rate;
    for (int e = 0; e < topology.elements(); ++e) {
      load.elements.push_back(e);
      load.mass.push_back(topology.type_of_element(e).mass);
    }
    loads.add(std::move(load));
  }
  void refuse(const TomlTable& top, const Scene& scene) const override {
    if (scene.has_ends(Ends::endless))
      throw top.table("centrifuge").error("", "does not go with a slice without ends", "take a whole rope");
  }
};

const KeyTable<CentrifugeDrive>& CentrifugeDrive::keys() {
  using Key = KeyOf<CentrifugeDrive>;
  static const KeyTable<CentrifugeDrive> table = {
      "centrifuge",
      "drives all elements away from the z axis; without this table, nothing does",
      {Key::number("rate_deg_per_ps", {"deg/ps", units::degree}, Bounds::positive(360), &CentrifugeDrive::rate,
                   required("1"), "rate at which the centrifuge turns")},
      {}};
  return table;
}

// In mdem/scene/loads/centrifuge.cpp this is the function that drive_kind.cpp names.
DriveKind centrifuge_drive() {
  return {[] { return CentrifugeDrive::keys().doc(); },
          [](const TomlTable& t, const Scene& scene) -> std::shared_ptr<const Drive> {
            return std::make_shared<CentrifugeDrive>(CentrifugeDrive::keys().read(t, scene));
          }};
}

const bool added = add_drive_kind(centrifuge_drive());

// --- and its tests ---

using ::testing::HasSubstr;

const std::string head =
    "format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-tersoff\"\n[rope]\ntubes = 7\nlength_nm = 6.9\n"
    "spacing_nm = 1.7\n[contact]\nlaw = \"none\"\n[damping]\nbond_damping_per_ps = 0\n";
const std::string turning = "[centrifuge]\nrate_deg_per_ps = 10\n";

Scene scene_from(const std::string& text) { return scene_of_text(head + text, "centrifuge.toml"); }

// A free tube at the distance r is driven to r cosh(w t), and the work is what its potential loses.
TEST(Centrifuge, DrivesATubeAway) {
  ASSERT_TRUE(added);
  Scene scene = scene_from(turning + "[run]\nduration_ps = 5\ntime_step_fs = 2\n");
  const Prepared p = prepare(scene);
  Simulation s = start(scene, p);
  const double rate = 10 * units::degree, total = s.total_energy();
  const auto potential = [&] {
    double sum = 0;
    for (int e = 0; e < p.topology.elements(); ++e) {
      const Vector3 x = s.state().position[static_cast<std::size_t>(e)];
      sum -= 0.5 * p.topology.type_of_element(e).mass * rate * rate * x.head<2>().squaredNorm();
    }
    return sum;
  };
  const double first = potential();
  s.steps(2500);
  const auto outer = static_cast<std::size_t>(p.topology.tube_begin[1]);
  EXPECT_NEAR(Vector3(s.state().position[outer]).head<2>().norm(), 1.7 * std::cosh(rate * 5), 1e-5);
  EXPECT_NEAR(Vector3(s.state().position[0]).head<2>().norm(), 0, 1e-12) << "the tube on the axis";
  EXPECT_NEAR(s.work(), first - potential(), 1e-4 * s.work());
  EXPECT_NEAR(s.total_energy() - total, s.work(), 1e-6 * s.work());
}

TEST(Centrifuge, IsTheSameForElementsHalfAsLong) {
  Scene scene = scene_from(turning + "[run]\nduration_ps = 5\n");
  const Prepared p = prepare(scene);
  Scene finer = scene_of_text(finer_scene_text(scene, p, "finer"), "centrifuge.toml");
  EXPECT_EQ(finer.drives_of<CentrifugeDrive>().at(0)->rate, scene.drives_of<CentrifugeDrive>().at(0)->rate);
  const Prepared after = prepare(finer);
  EXPECT_EQ(after.loads.of<CentrifugeLoad>().at(0)->elements.size(),
            2 * p.loads.of<CentrifugeLoad>().at(0)->elements.size());
}

TEST(Centrifuge, IsInHelpTemplatesAndErrors) {
  EXPECT_THAT(scene_key_help(), HasSubstr("[centrifuge]  drives all elements away"));
  EXPECT_THAT(scene_templates().front().text, HasSubstr("# [centrifuge]"));
  const auto message = [](const std::string& text) -> std::string {
    try {
      scene_from(text);
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_THAT(message("[centrifuge]\n[run]\nduration_ps = 1\n"),
              HasSubstr("centrifuge.toml:11: centrifuge.rate_deg_per_ps: is missing"));
  EXPECT_THAT(message(turning + "[periodic]\ntwist_deg_per_nm = [[0, 0]]\n[run]\nduration_ps = 1\n"),
              HasSubstr("centrifuge: does not go with a slice without ends"));
}

}  // namespace
}  // namespace ropewalk
