// The scene with elements of half the length.
#include "scene/finer.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "scene/ends/grip.hpp"
#include "scene/ends/twist.hpp"
#include "scene/loads/fix.hpp"
#include "scene/loads/rotate.hpp"
#include "scene/scene_toml.hpp"
#include "scene/watch.hpp"
#include "sim/dynamics/refine.hpp"
#include "unit/support.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

using ::testing::HasSubstr;

const std::string place = ROPEWALK_SOURCE_DIR "/data/scenes/test.toml";

struct CoarseAndFine {
  Scene coarse, fine;
  Prepared before, after;
  std::string text;

  explicit CoarseAndFine(const std::string& body, const std::string& top = "parameters = \"cnt-10-10-tersoff\"\n",
                         const std::string& path = place)
      : coarse(scene_of_text("format = \"ropewalk-scene-1\"\n" + top + body, path)) {
    before = prepare(coarse);
    text = finer_scene_text(coarse, before, "why");
    fine = scene_of_text(text, path);
    after = prepare(fine);
  }
};

void expect_halved(const CoarseAndFine& p) {
  const Topology expected = halved(p.before.topology), &found = p.after.topology;
  EXPECT_EQ(found.tube_begin, expected.tube_begin);
  EXPECT_EQ(found.tube_type, expected.tube_type);
  for (std::size_t k = 0; k < expected.types.size(); ++k) {
    EXPECT_DOUBLE_EQ(found.types[k].element_length, expected.types[k].element_length);
    EXPECT_NEAR(found.types[k].mass, expected.types[k].mass, 1e-15);
    EXPECT_NEAR(found.types[k].inertia, expected.types[k].inertia, 1e-15);
  }
  EXPECT_EQ(p.coarse.name, p.fine.name);
  EXPECT_DOUBLE_EQ(p.after.spacing, p.before.spacing);
  EXPECT_DOUBLE_EQ(p.after.duration, p.before.duration);
  EXPECT_EQ(p.text.rfind("# why\n", 0), 0u);
}

const std::string short_run = "[run]\nduration_ps = 1\n";

// 67 nm are 48.6 elements: 49, and of half the length 97.3, which must become 98.
TEST(FinerScene, KeepsTheTubesWhateverTheTypedLength) {
  const CoarseAndFine rope("[rope]\ntubes = 7\nlength_nm = 67\n" + short_run);
  ASSERT_EQ(rope.before.topology.length_of(0), 49);
  expect_halved(rope);
  expect_halved(CoarseAndFine("[film]\ntubes = 5\nlength_nm = 30\nwidth_nm = 40\ndepth_nm = 35\n" + short_run));
  expect_halved(CoarseAndFine("[chain]\nelements = 9\n" + short_run));
  expect_halved(CoarseAndFine("tube_types = [1, 0, 0, 0, 0, 0, 1]\n[rope]\ntubes = 7\nlength_nm = 14\n" + short_run,
                              "parameters = [\"cnt-10-10-tersoff\", \"cnt-5-5-tersoff\"]\n"));
}

TEST(FinerScene, TakesTheHalvedStateWhereThereIsOne) {
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("ropewalk-finer-" + std::to_string(std::random_device{}()));
  std::filesystem::create_directories(folder);
  const auto write = [&](int rows, double step) {
    std::ofstream out(folder / "here.csv");
    out << "tube,x_nm,y_nm,z_nm,qw,qx,qy,qz\n";
    for (int k = 0; k < rows; ++k) out << "0,0,0," << step * k << ",1,0,0,0\n";
  };
  write(4, 1.378);
  Scene coarse = scene_of_text(
      "format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-tersoff\"\n[state]\nfile = \"here.csv\"\n" +
          short_run,
      (folder / "scene.toml").string());
  const Prepared before = prepare(coarse);
  const std::string text = finer_scene_text(coarse, before, "why");
  write(8, 0.689);
  Scene fine = scene_of_text(text, (folder / "scene.toml").string());
  EXPECT_EQ(prepare(fine).topology.tube_begin, (std::vector<int>{0, 8}));
  std::filesystem::remove_all(folder);
}

// Forces and couples by tube: their sums, and the moment of the forces about the origin.
void total_loads(const Prepared& p, Vector3& force, Vector3& torque, Vector3& moment) {
  force = torque = moment = Vector3::Zero();
  std::vector<PointLoad> loads;
  point_loads(p.loads, p.state, 1e9, loads);
  for (const PointLoad& l : loads) {
    force += l.force;
    torque += l.torque;
    moment += p.state.position[static_cast<std::size_t>(l.element)].cross(l.force);
  }
}

TEST(FinerScene, LoadsStayAtTheirPlacesWithTheSameTotal) {
  const CoarseAndFine p(
      "[chain]\nelements = 7\n"
      "[[load]]\nkind = \"force\"\nelements = [-1, 2]\nforce_nN = [1, 2, 0.5]\n"
      "[[load]]\nkind = \"torque\"\nelements = \"ends\"\ntorque_nN_nm = [0, 0, 3]\n"
      "[[load]]\nkind = \"fix\"\nelements = [0, 5]\n"
      "[[load]]\nkind = \"rotate\"\nelements = [-2]\nrate_deg_per_ps = 1\nangle_deg = 90\n" +
      short_run);
  ASSERT_EQ(p.after.topology.elements(), 13);
  Vector3 force, torque, moment, fine_force, fine_torque, fine_moment;
  total_loads(p.before, force, torque, moment);
  total_loads(p.after, fine_force, fine_torque, fine_moment);
  EXPECT_GT(force.norm(), 1);
  EXPECT_LT((fine_force - force).norm(), 1e-12 * force.norm());
  EXPECT_LT((fine_torque - torque).norm(), 1e-12 * torque.norm());
  EXPECT_LT((fine_moment - moment).norm(), 1e-12 * moment.norm()) << "at the same place of the tube";
  std::vector<int> fixed;
  for (const FixLoad* f : p.after.loads.of<FixLoad>())
    fixed.insert(fixed.end(), f->elements.begin(), f->elements.end());
  EXPECT_EQ(fixed, (std::vector<int>{0, 10}));
  EXPECT_EQ(p.after.loads.of<PrescribedRotation>().at(0)->elements, (std::vector<int>{10}));
}

// Nothing holds a single element: the tube stays as long, and each half takes its part.
TEST(FinerScene, ALoadOnAllElementsIsSharedByTheHalves) {
  const CoarseAndFine p(
      "[chain]\nelements = 7\n[[load]]\nkind = \"force\"\nelements = \"all\"\nforce_nN = [1, 2, 0.5]\n" +
      short_run);
  expect_halved(p);
  Vector3 force, torque, moment, fine_force, fine_torque, fine_moment;
  total_loads(p.before, force, torque, moment);
  total_loads(p.after, fine_force, fine_torque, fine_moment);
  EXPECT_GT(force.norm(), 1);
  EXPECT_LT((fine_force - force).norm(), 1e-12 * force.norm());
}

TEST(FinerScene, EndsOfTheTwistStayWhereTheyAre) {
  const std::string twist = "[rope]\ntubes = 7\nlength_nm = 14\n[twist]\nmoment_nN_nm = 5\nrate_nN_nm_per_ps = 5\n";
  for (const char* reading : {"per-tube", "total"}) {
    const CoarseAndFine p(twist + "reading = \"" + reading + "\"\n");
    const auto before = p.before.loads.of<TwistLoad>(), after = p.after.loads.of<TwistLoad>();
    ASSERT_EQ(before.size(), 2u);
    ASSERT_EQ(after.size(), 2u);
    for (std::size_t grip = 0; grip < 2; ++grip) {
      ASSERT_EQ(after[grip]->elements.size(), before[grip]->elements.size());
      for (std::size_t t = 0; t < 7; ++t) {
        const Vector3 from = p.before.state.position[static_cast<std::size_t>(before[grip]->elements.at(t))],
                      to = p.after.state.position[static_cast<std::size_t>(after[grip]->elements.at(t))];
        EXPECT_LT((to - from).norm(), 1e-9);
      }
      EXPECT_EQ(after[grip]->moment, before[grip]->moment);
      EXPECT_EQ(after[grip]->sign, before[grip]->sign);
    }
    EXPECT_EQ(before[0]->sign + before[1]->sign, 0);
  }
}

// Clamps of one and of three elements: the innermost ones stay in place, and so do free length, schedules and
// collapse.
TEST(FinerScene, ClampsKeepTheFreeLength) {
  for (const int depth : {1, 3}) {
    const std::string in_clamp = "elements = " + std::to_string(depth) + "\n";
    const CoarseAndFine p(
        "[rope]\ntubes = 7\nlength_nm = 13.78\n[[grip]]\nend = \"lower\"\n" + in_clamp +
        "[[grip]]\nend = \"upper\"\n" + in_clamp +
        "z = { strain = 0.01, rate_per_ps = 0.001 }\nabout_z = { rotation_deg = [[0, 0], [9, 40]] }\n");
    const double a = p.before.topology.types[0].element_length, free = free_length(p.coarse, p.before.topology, 0);
    EXPECT_NEAR(free, (11 - 2 * depth) * a, 1e-12);
    EXPECT_NEAR(free_length(p.fine, p.after.topology, 0), free, 1e-9);
    EXPECT_NEAR(p.before.loads.of<GripLoad>().at(1)->schedule(GripLoad::z).largest(), 0.01 * free, 1e-12)
        << "a strain is one of what can stretch";
    EXPECT_NEAR(p.after.loads.of<GripLoad>().at(1)->schedule(GripLoad::z).largest(), 0.01 * free, 1e-9);
    EXPECT_NEAR(p.after.topology.types[0].bond.anharmonic.max_shear,
                p.before.topology.types[0].bond.anharmonic.max_shear, 1e-9);
    for (const double t : {1.0, 4.0, 8.0})
      EXPECT_NEAR(p.after.loads.of<GripLoad>().at(1)->schedule(GripLoad::about_z).value(t),
                  p.before.loads.of<GripLoad>().at(1)->schedule(GripLoad::about_z).value(t), 1e-9);
    const std::vector<int>& held = p.after.loads.of<GripLoad>().at(0)->elements;
    EXPECT_EQ(held.size(), 7u * static_cast<std::size_t>(2 * depth - 1));
    EXPECT_NEAR(
        p.after.state.position.z[static_cast<std::size_t>(held.at(static_cast<std::size_t>(2 * depth - 2)))],
        p.before.state.position.z[static_cast<std::size_t>(depth - 1)], 1e-9);
  }
}

TEST(FreeLength, IsThatBetweenWhatHoldsATube) {
  const auto elements = [](const std::string& drives) {
    Scene s = scene_of_text(
        "format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-tersoff\"\n[chain]\nelements = 10\n" + drives +
            short_run,
        place);
    const Prepared p = prepare(s);
    return free_length(s, p.topology, 0) / p.topology.types[0].element_length;
  };
  EXPECT_NEAR(elements(""), 10, 1e-9);
  EXPECT_NEAR(elements("[[load]]\nkind = \"force\"\nelements = \"all\"\nforce_nN = [1, 0, 0]\n"), 10, 1e-9);
  EXPECT_NEAR(elements("[[load]]\nkind = \"fix\"\nelements = [0]\n"), 9, 1e-9);
  EXPECT_NEAR(elements("[[load]]\nkind = \"fix\"\nelements = [0, 1, -1, 5]\n"), 8, 1e-9);
  EXPECT_NEAR(elements("[[load]]\nkind = \"force\"\nelements = [0, 1, -1]\nforce_nN = [1, 0, 0]\n"), 9, 1e-9);
  EXPECT_NEAR(elements("[[grip]]\nend = \"upper\"\nelements = 3\n"), 7, 1e-9);
}

TEST(FinerScene, NodesAndTypedStepGoWithTheLengthAndTheExclusionStays) {
  const CoarseAndFine p(
      "[rope]\ntubes = 7\nlength_nm = 14\n[contact]\nnodes_per_element = 6\nexclude_along_tube_nm = 7\n"
      "[run]\nduration_ps = 1\ntime_step_fs = 7\n[limits]\nbend_deg = 12\n");
  EXPECT_EQ(p.fine.contact.nodes, 3);
  EXPECT_EQ(p.fine.contact.exclude_along_tube, 7);
  EXPECT_NEAR(p.after.time_step / p.after.limit.limit, p.before.time_step / p.before.limit.limit, 1e-12);
  EXPECT_LT(p.after.time_step, 0.8 * p.before.time_step);
  EXPECT_NEAR(watched_of(p.fine, p.after.topology, p.after.loads, p.after.interaction.law.get()).limits.at(0).bend,
              12 * units::degree, 1e-12);
}

// The power that the same sliding and the same stretching and twisting take, per length of tube.
TEST(FinerScene, DissipationPerLengthStays) {
  const CoarseAndFine p("[chain]\nelements = 9\n" + short_run);
  const auto sliding = [](const Prepared& prepared, double reach) {
    ContactViscosity law = prepared.interaction.damping.contact;
    law.inner = reach;
    law.outer = 1.5 * reach;
    const double a = prepared.topology.types[0].element_length;
    double sum = 0;  // over one element against a row, mean over where it stands
    for (int shift = 0; shift < 64; ++shift)
      for (int k = -40; k <= 40; ++k) sum += law.weight(std::hypot(1.01 * reach, (k + shift / 64.0) * a)) / 64;
    return law.eta * sum / a;
  };
  EXPECT_NEAR(sliding(p.after, 1.7) / sliding(p.before, 1.7), 1, 1e-4);
  const auto straining = [](const Prepared& prepared) {
    const TubeType& t = prepared.topology.types[0];
    const double a = t.element_length;
    const auto f =
        prepared.interaction.damping.bond.force(t.mass, t.inertia, Vector3(0, 0, a), Vector3(0, 0, 0),
                                                Vector3(0, 0, 0), Vector3(0, 0, 0.01 * a), Vector3(0, 0, 0.02 * a));
    return f.power / a;
  };
  EXPECT_LT(straining(p.before), 0);
  EXPECT_NEAR(straining(p.after) / straining(p.before), 1, 1e-12);
}

TEST(FinerScene, SaysWhyNot) {
  const CoarseAndFine p("[chain]\nelements = 9\n" + short_run);
  EXPECT_EQ(why_not_finer(p.coarse, p.before.topology), "");
  EXPECT_THAT(why_not_finer(p.fine, p.after.topology), HasSubstr("shorter than the radius"));
  const CoarseAndFine breaks("[chain]\nelements = 9\n[failure]\nstrain = 0.05\n" + short_run);
  EXPECT_EQ(why_not_finer(breaks.coarse, breaks.before.topology), "") << "a tube is as strong in shorter elements";
  Scene scatters = scene_of_text("format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-tersoff\"\n[chain]\n"
                                 "elements = 9\n[failure]\nstrain = 0.05\nstrain_deviation = 0.01\n" + short_run,
                                 place);
  EXPECT_THAT(why_not_finer(scatters, prepare(scatters).topology), HasSubstr("draws a strain for every bond"));
  Scene paper = scene_of_text(
      "format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-paper\"\n[chain]\nelements = 9\n" + short_run,
      place);
  EXPECT_THAT(why_not_finer(paper, prepare(paper).topology), HasSubstr("law \"paper\""));
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
