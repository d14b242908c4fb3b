// A periodic slice: its forces are those of an endless rope, it keeps energy and momentum, and its torque is that
// of the middle of a long rope.
#include "scene/loads/periodic.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "model/error.hpp"
#include "run/run_directory.hpp"
#include "scene/finer.hpp"
#include "scene/random.hpp"
#include "scene/scene_toml.hpp"
#include "scene/watch.hpp"

namespace ropewalk {
namespace {

using ::testing::HasSubstr;

std::string slice_text(int tubes, int elements, const std::string& more) {
  return fmt::format(
      "format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-tersoff\"\n[rope]\ntubes = {}\nlength_nm = {}\n"
      "[contact]\nprecision = \"double\"\n{}",
      tubes, elements * 1.3775870846, more);
}

struct Slice {
  Scene scene;
  Prepared p;
  const PeriodicLoad* load;
  int images, own;

  explicit Slice(const std::string& text)
      : scene(scene_of_text(text, "slice.toml")), p(prepare(scene)), load(p.loads.of<PeriodicLoad>().front()) {
    images = load->images;
    own = p.topology.length_of(0) - 2 * images;
  }
  bool is_image(int element) const {
    const int k = element - p.topology.tube_begin[p.topology.tube_of(element)];
    return k < images || k >= images + own;
  }
};

void shake(const Slice& slice, State& s, double by, double speed) {
  Random random(5);
  const auto any = [&] { return Vector3(random.normal(), random.normal(), random.normal()); };
  for (std::size_t i = 0; i < s.size(); ++i) {
    s.position.set(i, Vector3(s.position[i]) + by * any());
    s.orientation.set(i, (Quaternion(Eigen::AngleAxisd(by, any().normalized())) * s.orientation[i]).normalized());
    s.velocity.set(i, speed * any());
    s.angular_velocity.set(i, speed * any());
  }
  slice.load->place(slice.p.topology, s);
}

// Three periods and their images, copied out by hand.
TEST(PeriodicSlice, ForcesAreThoseOfAnEndlessRope) {
  const double twist = 1.5;  // deg/nm
  Slice slice(
      slice_text(7, 20, fmt::format("[periodic]\ntwist_deg_per_nm = [[0, {}]]\n[run]\nduration_ps = 1\n", twist)));
  shake(slice, slice.p.state, 0.01, 0);
  const Simulation s = start(slice.scene, slice.p);
  const int n = slice.own, g = slice.images;
  Slice whole(slice_text(7, 3 * n + 2 * g, "[periodic]\ntwist_deg_per_nm = [[0, 0]]\n[run]\nduration_ps = 1\n"));
  const double angle = twist * units::degree * slice.load->period();
  for (int t = 0; t < 7; ++t)
    for (int k = 0; k < 3 * n + 2 * g; ++k) {
      const int period = static_cast<int>(std::floor((k - g - n) / static_cast<double>(n)));
      const auto from = static_cast<std::size_t>(slice.p.topology.tube_begin[t] + g + (k - g - n - period * n)),
                 to = static_cast<std::size_t>(whole.p.topology.tube_begin[t] + k);
      const Quaternion r(Eigen::AngleAxisd(period * angle, Vector3::UnitZ()));
      whole.p.state.position.set(
          to, r * Vector3(slice.p.state.position[from]) + Vector3(0, 0, period * slice.load->period()));
      whole.p.state.orientation.set(to, (r * slice.p.state.orientation[from]).normalized());
    }
  const Simulation all(whole.p.topology, whole.p.interaction, {}, whole.p.state, whole.p.time_step);
  double largest = 0;
  for (int t = 0; t < 7; ++t)
    for (int k = 0; k < n; ++k) {
      const auto a = static_cast<std::size_t>(slice.p.topology.tube_begin[t] + g + k),
                 b = static_cast<std::size_t>(whole.p.topology.tube_begin[t] + g + n + k);
      const Vector3 f = s.forces().force[a], h = all.forces().force[b], m = s.forces().torque[a],
                    o = all.forces().torque[b];
      largest = std::max(largest, h.norm());
      EXPECT_LT((f - h).norm(), 1e-9);
      EXPECT_LT((m - o).norm(), 1e-9);
    }
  EXPECT_GT(largest, 1);
}

void expect_conserved(double step_fs, double energy) {
  Slice slice(slice_text(
      7, 20,
      fmt::format("[periodic]\ntwist_deg_per_nm = [[0, 1]]\n[damping]\n"
                  "contact_viscosity_eV_ps_per_nm2 = 0\nbond_damping_per_ps = 0\n[run]\nduration_ps = 1\n"
                  "time_step_fs = {}\n",
                  step_fs)));
  shake(slice, slice.p.state, 0.002, 0.02);
  Simulation s = start(slice.scene, slice.p);
  const auto momenta = [&] {
    Vector3 sum = Vector3::Zero();  // p_z, L_z, and the sum of |p_z| for the scale
    const State& state = s.state();
    for (int e = 0; e < slice.p.topology.elements(); ++e) {
      if (slice.is_image(e)) continue;
      const auto i = static_cast<std::size_t>(e);
      const TubeType& type = slice.p.topology.type_of_element(e);
      const Vector3 x = state.position[i], v = state.velocity[i], w = state.angular_velocity[i];
      sum += Vector3(type.mass * v.z(), type.mass * x.cross(v).z() + type.inertia * w.z(),
                     type.mass * std::fabs(v.z()));
    }
    return sum;
  };
  s.steps(1, true);
  const Vector3 before = momenta();
  const double first = s.total_energy() - s.work(), kinetic = kinetic_energy(slice.p.topology, s.state());
  s.steps(std::lround(20e3 / step_fs), true);
  const Vector3 after = momenta();
  EXPECT_NEAR(after[0], before[0], 1e-9 * before[2]);
  EXPECT_NEAR(after[1], before[1], 1e-8 * before[2]);
  EXPECT_NEAR(s.total_energy() - s.work(), first, energy * kinetic);
  // Images are where they belong, without drift.
  State placed = s.state();
  slice.load->place(slice.p.topology, placed);
  for (std::size_t i = 0; i < placed.size(); ++i)
    EXPECT_LT((Vector3(placed.position[i]) - Vector3(s.state().position[i])).norm(), 1e-10);
}

// The error of the energy goes as the square of the step.
TEST(PeriodicSlice, KeepsEnergyAndMomentum) {
  expect_conserved(8, 8e-3);
  expect_conserved(2, 5e-4);
}

// Images are led to where they will be while the twist grows.
TEST(PeriodicSlice, ImagesFollowATwistThatGrows) {
  Slice slice(slice_text(7, 20, "[periodic]\ntwist_deg_per_nm = [[0, 0], [20, 2], [30, 2]]\n"));
  shake(slice, slice.p.state, 0.002, 0.02);
  Simulation s = start(slice.scene, slice.p);
  s.steps(std::lround(22 / slice.p.time_step), true);
  State placed = s.state();
  slice.load->place(slice.p.topology, placed);
  for (std::size_t i = 0; i < placed.size(); ++i) {
    EXPECT_LT((Vector3(placed.position[i]) - Vector3(s.state().position[i])).norm(), 1e-10);
    EXPECT_LT(placed.orientation[i].angularDistance(s.state().orientation[i]), 1e-9);
  }
}

// GJ tau of a single tube.
TEST(PeriodicSlice, ReadsTheTorqueOfATube) {
  Slice slice(
      slice_text(1, 40,
                 "law = \"none\"\n[bond]\nlaw = \"harmonic\"\n[periodic]\ntwist_deg_per_nm = [[0, 0], [50, 1], "
                 "[200, 1]]\n[damping]\nbond_damping_per_ps = 2\n"));
  Simulation s = start(slice.scene, slice.p);
  s.steps(std::lround(190 / slice.p.time_step), true);
  s.read_gauges();
  s.steps(std::lround(10 / slice.p.time_step), true);
  const EndReadings ends = s.read_gauges();
  const double expected = slice.scene.parameters().bond.twist * 1 * units::degree;
  EXPECT_NEAR(ends[upper_end].torque.z(), expected, 1e-4 * expected);
  EXPECT_NEAR(ends[lower_end].torque.z(), -expected, 1e-4 * expected);
}

// 19 tubes against the middle third of a rope five times as long, between discs in which tubes tilt.
TEST(PeriodicSlice, IsTheMiddleOfALongRope) {
  const double twist = 1.5, ramp = 60, hold = 200, read = 40;
  const auto ends_of_run = [&](const std::string& text) {
    Scene scene = scene_of_text(text, "rope.toml");
    const Prepared p = prepare(scene);
    const Observer observer = make_observer(scene, p);
    Simulation s = start(scene, p);
    s.steps(std::lround((ramp + hold - read) / p.time_step), true);
    s.read_gauges();
    s.steps(std::lround(read / p.time_step), true);
    EnergyAccount account;
    account.ends = s.read_gauges();
    account.potential = s.forces().energy;
    return log_row(observer, scene, p.topology, s.state(), account);
  };
  const LogRow slice =
      ends_of_run(slice_text(19, 16,
                             fmt::format("[periodic]\ntwist_deg_per_nm = [[0, 0], [{}, {}], [{}, {}]]\n", ramp,
                                         twist, ramp + hold, twist)));
  const int elements = 60;
  const double turned = twist * (elements - 1) * 1.3775870846;
  const LogRow rope = ends_of_run(slice_text(
      19, elements,
      fmt::format(
          "[[grip]]\nend = \"lower\"\ntilt_free = true\n[[grip]]\nend = \"upper\"\ntilt_free = true\nabout_z = {{ "
          "rotation_deg = [[0, 0], [{}, {}], [{}, {}]] }}\n",
          ramp, turned, ramp + hold, turned)));
  // The long rope still swings: its two ends read alike in the mean.
  const auto torque = [](const LogRow& r) { return 0.5 * (r["torque_upper_nN_nm"] + r["torque_lower_nN_nm"]); };
  EXPECT_NEAR(torque(slice), torque(rope), 0.01 * torque(rope));
  for (const char* same : {"beta_deg", "tension_upper_nN"})
    EXPECT_NEAR(slice[same], rope[same], 0.01 * std::fabs(rope[same])) << same;
  EXPECT_EQ(slice["Q"], rope["Q"]);
  EXPECT_NEAR(slice["torque_lower_nN_nm"], slice["torque_upper_nN_nm"], 1e-4 * torque(slice));
  // Per bond, since a slice has more ends for its length.
  EXPECT_NEAR(slice["twist_eV"] / 15, rope["twist_eV"] / (elements - 1), 5e-3 * slice["twist_eV"] / 15);
}

// The tubes of a slice are endless. Bonds and watched limits take the collapse of an endless tube, whatever the length of
// the slice.
TEST(PeriodicSlice, CollapsesAsAnEndlessTubeDoes) {
  for (const int elements : {9, 16, 44}) {  // 12, 22 and 60 nm
    const Slice slice(
        slice_text(7, elements, "[periodic]\ntwist_deg_per_nm = [[0, 0], [9, 4]]\n[run]\nduration_ps = 1\n"));
    const ParameterSet& set = slice.scene.parameters();
    const double endless = set.validity.collapse_at(set.radius, 0);
    ASSERT_LT(endless, 0.95 * set.validity.collapse_at(set.radius, 60));
    EXPECT_EQ(slice.p.topology.types[0].bond.anharmonic.max_shear, endless);
    EXPECT_EQ(watched_of(slice.scene, slice.p.topology, slice.p.interaction.law.get()).limits.at(0).wall_twist,
              endless);
    EXPECT_EQ(validities(slice.scene, slice.p.topology).at(0).twist_collapse, endless);
  }
}

TEST(PeriodicSlice, IsNotRefined) {
  const Slice slice(slice_text(7, 20, "[periodic]\ntwist_deg_per_nm = [[0, 1]]\n[run]\nduration_ps = 1\n"));
  EXPECT_THAT(why_not_finer(slice.scene, slice.p.topology), HasSubstr("counts its images in elements"));
}

TEST(PeriodicSlice, RefusesWhatHasNoMeaning) {
  const auto said = [](const std::string& text) {
    try {
      Slice slice(text);
    } catch (const InputError& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  EXPECT_THAT(said(slice_text(7, 5, "[periodic]\ntwist_deg_per_nm = [[0, 0]]\n[run]\nduration_ps = 1\n")),
              HasSubstr("make the tubes at least"));
  EXPECT_THAT(
      said(slice_text(7, 20, "[periodic]\ntwist_deg_per_nm = [[0, 0]]\nimages = 1\n[run]\nduration_ps = 1\n")),
      HasSubstr("the contact reaches"));
  EXPECT_THAT(said(slice_text(7, 20,
                              "[periodic]\ntwist_deg_per_nm = [[0, 0]]\n[twist]\nmoment_nN_nm = "
                              "5\nrate_nN_nm_per_ps = 1\nhold_ps = 1\n")),
              HasSubstr("does not go with [twist]"));
  const auto pulled = [&](const char* elements) {
    return said(
        slice_text(7, 20,
                   fmt::format("[periodic]\ntwist_deg_per_nm = [[0, 0]]\n[[load]]\nkind = \"force\"\nelements "
                               "= {}\nforce_nN = [0, 0, 1]\n[run]\nduration_ps = 1\n",
                               elements)));
  };
  EXPECT_THAT(pulled("\"ends\""),
              HasSubstr("element 0 of tube 0 is an image of the slice, and a load on it has no effect"));
  EXPECT_EQ(pulled("[10]"), "");
  EXPECT_EQ(pulled("\"all\""), "");
  EXPECT_THAT(said(slice_text(7, 20, "[periodic]\ntwist_deg_per_nm = [[0, 0]]\n[run]\nmode = \"relax\"\n")),
              HasSubstr("follow it in time"));
}

}  // namespace
}  // namespace ropewalk
