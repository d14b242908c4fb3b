// [plies]: ropes side by side and wound round one another: scene/kinds/plies.hpp.
#include "scene/kinds/plies.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>

#include "model/segments.hpp"
#include "model/units.hpp"
#include "observe/centre_line.hpp"
#include "run/run_directory.hpp"
#include "scene/ends/grip.hpp"
#include "scene/prepare.hpp"
#include "scene/scene_to_model.hpp"
#include "scene/scene_toml.hpp"
#include "scene/state_csv.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

using ::testing::HasSubstr;
using units::degree;

Scene scene_of(const std::string& plies, const std::string& more = "", const char* set = "cnt-10-10-tersoff") {
  return scene_of_text(std::string("format = \"ropewalk-scene-1\"\nparameters = \"") + set + "\"\n[plies]\n" +
                           plies + more + "[run]\nduration_ps = 1\n",
                       "plies.toml");
}
const std::string two = "ropes = 2\ntubes = 7\n", straight = two + "length_nm = 41.3\n",
                  wound = two + "length_nm = 67.5\nply_twist_deg_per_nm = 5\n";

std::string message(const std::string& plies) {
  try {
    Scene scene = scene_of(plies);
    prepare(scene);
    return "none";
  } catch (const InputError& e) {
    return e.what();
  }
}

// The least distance of the axes of elements of two ropes, or of different tubes of one rope.
double least_distance(const Prepared& p, bool of_one_rope) {
  const double half = 0.5 * p.topology.types[0].element_length;
  double least = std::numeric_limits<double>::infinity();
  const auto rope_of = [&](int tube) { return tube / p.topology.strands_of_rope(0).second; };
  for (int a = 0; a < p.topology.tubes(); ++a)
    for (int b = a + 1; b < p.topology.tubes(); ++b) {
      if ((rope_of(a) == rope_of(b)) != of_one_rope) continue;
      for (int i = p.topology.tube_begin[a]; i < p.topology.tube_begin[a + 1]; ++i)
        for (int j = p.topology.tube_begin[b]; j < p.topology.tube_begin[b + 1]; ++j) {
          const auto k = static_cast<std::size_t>(i), l = static_cast<std::size_t>(j);
          least = std::min(least, squared_segment_distance(p.state.position[l] - p.state.position[k],
                                                           axis_of(p.state.orientation[k]),
                                                           axis_of(p.state.orientation[l]), half, half));
        }
    }
  return std::sqrt(least);
}

RopeObservation seen_in(const Scene& scene, const Prepared& p) {
  return observe(make_observer(scene, p), scene, p.topology, p.state);
}

TEST(Plies, TouchWhereTheyBindBest) {
  for (const auto& [ropes, tubes] : {std::pair{2, 1}, {2, 7}, {2, 19}, {3, 7}, {4, 7}, {6, 12}}) {
    SCOPED_TRACE(std::to_string(ropes) + " ropes of " + std::to_string(tubes));
    Scene scene = scene_of("ropes = " + std::to_string(ropes) + "\ntubes = " + std::to_string(tubes) +
                           "\npacking = \"round\"\nlength_nm = 5.6\n");
    const Prepared p = prepare(scene);
    ASSERT_EQ(p.topology.tubes(), ropes * tubes);
    ASSERT_EQ(p.topology.ropes(), ropes);
    EXPECT_NEAR(least_distance(p, false), p.spacing, 1e-9) << "none pressed, none loose";
    if (tubes > 1) {
      EXPECT_NEAR(least_distance(p, true), p.spacing, 1e-9);
    }
    for (std::size_t i = 0; i < p.state.size(); ++i) EXPECT_NEAR(p.state.orientation[i].w(), 1, 1e-12);
  }
}

// Two hexagons of seven places on one lattice: their middles are the root of 7 apart, and three pairs of tubes
// touch.
TEST(Plies, OfSevenTubesLieInOneLattice) {
  Scene scene = scene_of(straight);
  const Prepared p = prepare(scene);
  const std::vector<CentreLine> lines = rope_lines(p.topology, p.state);
  EXPECT_NEAR((lines[0].points[3] - lines[1].points[3]).norm(), std::sqrt(7.0) * p.spacing, 1e-6);
  int touching = 0;
  for (int a = 0; a < 7; ++a)
    for (int b = 7; b < 14; ++b) {
      const auto i = static_cast<std::size_t>(p.topology.tube_begin[a]),
                 j = static_cast<std::size_t>(p.topology.tube_begin[b]);
      touching += (p.state.position[j] - p.state.position[i]).norm() < 1.001 * p.spacing;
    }
  EXPECT_EQ(touching, 3);
  const RopeObservation o = seen_in(scene, p);
  EXPECT_NEAR(o.ply_angle, 0, 1e-12);
  EXPECT_EQ(o.middle.contacts, 24) << "of both ropes by themselves";
  EXPECT_EQ(o.middle.voids, 0) << "the grooves between them are none";
}

TEST(Plies, AreWoundInHelicesThatTouch) {
  for (const double turn : {5.0, -5.0}) {
    SCOPED_TRACE(turn);
    Scene scene = scene_of(two + "length_nm = 67.5\nply_twist_deg_per_nm = " + std::to_string(turn) + "\n");
    const Prepared p = prepare(scene);
    const double a = p.topology.types[0].element_length, T = turn * degree;
    EXPECT_NEAR(least_distance(p, false), p.spacing, 2e-3) << "of straight elements";
    for (int t = 0; t < 14; ++t)
      for (int e = p.topology.tube_begin[t]; e + 1 < p.topology.tube_begin[t + 1]; ++e)
        ASSERT_NEAR(
            (p.state.position[static_cast<std::size_t>(e) + 1] - p.state.position[static_cast<std::size_t>(e)])
                .norm(),
            a, 1e-9);
    // The core tube of a rope is its centre line, a helix.
    const auto place = [&](int tube, int k) -> Vector3 {
      return p.state.position[static_cast<std::size_t>(p.topology.tube_begin[tube] + k)];
    };
    const double R = place(0, 10).head<2>().norm();
    for (int k = 0; k < p.topology.length_of(0); ++k) {
      const Vector3 x = place(0, k), y = place(7, k);
      EXPECT_NEAR(x.head<2>().norm(), R, 1e-9);
      EXPECT_NEAR((x.head<2>() + y.head<2>()).norm(), 0, 1e-9) << "opposite the other rope";
      const double azimuth = T * x.z();
      EXPECT_NEAR(std::remainder(std::atan2(x.y(), x.x()) - azimuth, 2 * units::pi), 0, 1e-9);
    }
    const RopeObservation o = seen_in(scene, p);
    const double theta = std::atan(R * T);
    EXPECT_NEAR(o.ply_angle, theta, 0.01 * std::fabs(theta));
    EXPECT_NEAR(theta / degree, turn > 0 ? 11.5 : -11.5, 0.5);
    // Wound as one body: the section turns by T cos^2 theta per length of rope, and so does each tube about itself.
    const double own = T * std::pow(std::cos(theta), 2);
    EXPECT_NEAR(o.physical_twist / (own * 48 * a), 1, 0.03);
    EXPECT_NEAR(o.beta, std::atan(p.spacing * std::fabs(own)), 0.04 * o.beta);
  }
}

TEST(Plies, WithoutATwistOfTheirOwnHaveParallelTubes) {
  Scene scene = scene_of(wound + "rope_twist_deg_per_nm = 0\n");
  const Prepared p = prepare(scene);
  const RopeObservation o = seen_in(scene, p);
  EXPECT_LT(o.beta, 0.2 * degree);
  EXPECT_LT(std::fabs(o.physical_twist), 1 * degree);
  EXPECT_GT(o.ply_angle, 10 * degree);
  EXPECT_NEAR(least_distance(p, false), p.spacing, 5e-3) << "where two tubes face each other";
  EXPECT_GT(least_distance(p, true), 0.997 * p.spacing) << "parallel tubes do not press each other";
}

TEST(Plies, KeepTheirRopesInAStateFile) {
  Scene scene = scene_of(wound);
  const Prepared p = prepare(scene);
  const std::filesystem::path file = std::filesystem::path(::testing::TempDir()) / "plies.csv";
  std::ofstream(file) << state_csv(p.topology, p.state);
  Topology read = p.topology;
  State state;
  read_state_csv(file.string(), read, state);
  EXPECT_EQ(read.groups.rope_begin, (std::vector<int>{0, 7, 14}));
  Scene again =
      scene_of_text("format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-tersoff\"\n[state]\nfile = \"" +
                        file.string() + "\"\n[run]\nduration_ps = 1\n",
                    "again.toml");
  const Prepared q = prepare(again);
  EXPECT_NEAR(seen_in(again, q).ply_angle, seen_in(scene, p).ply_angle, 1e-9);
  EXPECT_EQ(seen_in(again, q).middle.contacts, seen_in(scene, p).middle.contacts);
  const std::string good = state_csv(p.topology, p.state), words = "ropes_begin_with_strands: 0,7";
  for (const char* wrong : {"0,14", "0,x", "1,7", "0,7,7"}) {
    std::string damaged = good;
    ASSERT_NE(damaged.find(words), std::string::npos);
    damaged.replace(damaged.find(words) + words.size() - 3, 3, wrong);
    std::ofstream(file) << damaged;
    EXPECT_THROW(read_state_csv(file.string(), read, state), InputError) << wrong;
  }
  std::filesystem::remove(file);
}

TEST(Plies, AreHeldByGripsAsOne) {
  Scene scene = scene_of(wound, "[[grip]]\nend = \"lower\"\n[[grip]]\nend = \"upper\"\n");
  const Prepared p = prepare(scene);
  const std::vector<const GripLoad*> grips = p.loads.of<GripLoad>();
  ASSERT_EQ(grips.size(), 2u);
  for (const GripLoad* grip : grips) EXPECT_EQ(grip->elements.size(), 14u);
}

TEST(Plies, StayRopesWhereTubesBreak) {
  Scene scene = scene_of(straight);
  const Prepared p = prepare(scene);
  std::vector<char> flags(static_cast<std::size_t>(p.topology.elements()), 0);
  flags[12] = 1;
  const Topology cut = cut_behind(p.topology, flags);
  EXPECT_EQ(cut.tubes(), 15);
  EXPECT_EQ(cut.ropes(), 2);
  EXPECT_EQ(strands_of(cut).strands_of_rope(1), (std::pair<int, int>{7, 14}));
}

TEST(Plies, RefuseWhatCannotBePlaced) {
  EXPECT_THAT(message("ropes = 1\ntubes = 7\nlength_nm = 20\n"), HasSubstr("plies.toml:4: plies.ropes: is 1"));
  EXPECT_THAT(message("ropes = 1\ntubes = 7\nlength_nm = 20\n"), HasSubstr("or a [rope]"));
  EXPECT_THAT(message("ropes = 7\ntubes = 7\nlength_nm = 20\n"), HasSubstr("plies.ropes"));
  EXPECT_THAT(message("ropes = 2\ntubes = 8\nlength_nm = 20\n"), HasSubstr("packing = \"round\" takes any number"));
  EXPECT_THAT(message(two + "length_nm = 2\n"), HasSubstr("plies.length_nm: is 2 nm, 1 elements"));
  EXPECT_THAT(message(two + "length_nm = 20\nply_twist_deg_per_nm = 25\n"),
              HasSubstr("plies.toml:7: plies.ply_twist_deg_per_nm: "));
  EXPECT_THAT(message(two + "length_nm = 20\nply_twist_deg_per_nm = 25\n"), HasSubstr("lower the number"));
  EXPECT_THAT(message(two + "length_nm = 20\nply_twist_deg_per_nm = 12\nrope_twist_deg_per_nm = 0\n"),
              HasSubstr("kink"));
  EXPECT_THAT(message(two + "length_nm = 20\nply_twists_deg_per_nm = 1\n"), HasSubstr("did you mean"));
  EXPECT_THAT(message("ropes = 6\ntubes = 1000000\nlength_nm = 2000\npacking = \"round\"\n"),
              HasSubstr("plies.length_nm: asks for"));
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
