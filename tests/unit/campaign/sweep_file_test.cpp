// Sweeps: their points, names and refusals.
#include "campaign/sweep_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <set>

#include "model/error.hpp"
#include "scene/ends/twist.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
namespace fs = std::filesystem;

class SweepFile : public ::testing::Test {
 protected:
  void SetUp() override {
    dir = fs::temp_directory_path() / ("ropewalk-sweep-" + std::to_string(getpid()));
    fs::create_directories(dir);
    std::ofstream(dir / "rope.toml") << "format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-tersoff\"\n"
                                        "[rope]\ntubes = 7\nlength_nm = 13.56\n"
                                        "[twist]\nmoment_nN_nm = 8\nrate_nN_nm_per_ps = 1\n";
  }
  void TearDown() override { fs::remove_all(dir); }

  Sweep sweep(const std::string& rest) const {
    return sweep_of_text("format = \"ropewalk-sweep-1\"\nscene = \"rope.toml\"\n" + rest,
                         (dir / "s.toml").string());
  }
  std::vector<std::string> names(const std::string& rest) const {
    std::vector<std::string> out;
    for (const SweepPoint& p : points_of(sweep(rest))) out.push_back(p.name);
    return out;
  }
  std::string refusal(const std::string& rest) const {
    try {
      points_of(sweep(rest));
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  }

  fs::path dir;
};

// Each point has other noise, on the same tubes; points that differ in their seed, or leave one start, have one
// stream.
TEST_F(SweepFile, PointsHaveNoiseOfTheirOwn) {
  std::ofstream(dir / "rope.toml", std::ios::app) << "[start]\ntemperature_K = 10\nmay_cool = true\n";
  const auto streams = [&](const std::string& rest) {
    const Sweep s = sweep(rest);
    std::vector<std::uint64_t> out;
    for (const SweepPoint& p : points_of(s)) out.push_back(scene_of(s, p).start.stream);
    return out;
  };
  const std::string moments = "[vary]\ntwist.moment_nN_nm = [8, 9]\n";
  const std::vector<std::uint64_t> own = streams("replicates = 2\n" + moments);
  ASSERT_EQ(own.size(), 4u);
  EXPECT_NE(own[0], 0u);
  EXPECT_EQ(own[0], own[1]) << "the seeds differ";
  EXPECT_NE(own[0], own[2]);
  EXPECT_THAT(streams("common_noise = true\n" + moments), ElementsAre(0, 0));
  EXPECT_THAT(streams("replicates = 2\n"), ElementsAre(0, 0));
  EXPECT_THAT(streams("[vary]\nstart.stream = [3, 4]\n"), ElementsAre(3, 4));
  const Sweep branched =
      sweep(moments + "[branch]\nat_ps = 2\n[branch.vary]\ndamping.bond_damping_per_ps = [1, 2]\n");
  const std::vector<SweepPoint> points = points_of(branched);
  const SweepPoint start = starts_of(branched, points)[0];
  EXPECT_EQ(scene_of(branched, points[0]).start.stream, scene_of(branched, start).start.stream);
  EXPECT_EQ(scene_of(branched, points[1]).start.stream, scene_of(branched, start).start.stream);
}

TEST_F(SweepFile, GridTakesEveryValueWithEveryOther) {
  EXPECT_THAT(names("replicates = 2\n[vary]\nrope.tubes = [7, 19]\ncontact.law = [\"line\"]\n"),
              ElementsAre("tubes-7_seed-1", "tubes-7_seed-2", "tubes-19_seed-1", "tubes-19_seed-2"));
  const std::vector<SweepPoint> points =
      points_of(sweep("[vary]\ntwist.moment_nN_nm = { from = 1, to = 2, points = 3 }\n"));
  ASSERT_EQ(points.size(), 3u);
  const Sweep middle = sweep("[vary]\ntwist.moment_nN_nm = [1.5]\n");
  const auto moment_of = [&](const SweepPoint& point) {
    return scene_of(middle, point).drives_of<TwistDrive>().at(0)->load.moment;
  };
  EXPECT_EQ(moment_of(points[1]), moment_of(points_of(middle)[0]));
  EXPECT_LT(points[0].work, points[2].work);  // a longer ramp
}

// Elements of another length between the same ends: 10 of 1.378 nm, 9 of them free, are 19 of half the length. A
// chain that nothing holds stays as long.
TEST_F(SweepFile, OtherElementLengthsKeepTheFreeLength) {
  const Sweep held = sweep("[vary]\nelement_length_nm = [1.3775870846, 0.6887935423, 0.9183913897]\n");
  std::vector<int> elements;
  for (const SweepPoint& p : points_of(held)) {
    const Scene s = scene_of(held, p);
    elements.push_back(s.source->sizes(s.element_length).elements);
  }
  EXPECT_THAT(elements, ElementsAre(10, 19, 14 + 1));
  std::ofstream(dir / "rope.toml") << "format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-tersoff\"\n"
                                      "[chain]\nelements = 10\n[run]\nduration_ps = 1\n";
  const Sweep loose = sweep("[vary]\nelement_length_nm = [0.6887935423]\nstart.seed = [1, 2]\n");
  for (const SweepPoint& p : points_of(loose)) {
    const Scene s = scene_of(loose, p);
    EXPECT_EQ(s.source->sizes(s.element_length).elements, 20);
  }
}

TEST_F(SweepFile, ZipTakesThemSideBySideAndSeedsAfterwards) {
  EXPECT_THAT(names("combine = \"zip\"\nreplicates = 2\n[vary]\nrope.tubes = [7, 19]\nrope.length_nm = [20, 30]\n"),
              ElementsAre("tubes-7_length_nm-20_seed-1", "tubes-7_length_nm-20_seed-2",
                          "tubes-19_length_nm-30_seed-1", "tubes-19_length_nm-30_seed-2"));
}

TEST_F(SweepFile, RangesAreEvenOrInEvenRatios) {
  EXPECT_THAT(names("[vary]\ntwist.moment_nN_nm = { from = 1, to = 1.2, step = 0.1 }\n"),
              ElementsAre("moment_nN_nm-1", "moment_nN_nm-1.1", "moment_nN_nm-1.2"));
  EXPECT_THAT(names("[vary]\ntwist.moment_nN_nm = { from = 1, to = 4, points = 3, log = true }\n"),
              ElementsAre("moment_nN_nm-1", "moment_nN_nm-2", "moment_nN_nm-4"));
}

TEST_F(SweepFile, BranchesShareAStart) {
  const std::string text =
      "[vary]\nrope.tubes = [7, 19]\n[branch]\nat_ps = 4\n[branch.vary]\ntwist.hold_ps = [1, 2]\n";
  const std::vector<SweepPoint> points = points_of(sweep(text));
  ASSERT_EQ(points.size(), 4u);
  EXPECT_EQ(points[0].start, "tubes-7");
  EXPECT_EQ(points[3].start, "tubes-19");
  EXPECT_EQ(starts_of(sweep(text), points).size(), 2u);
}

TEST_F(SweepFile, WrongOnesGetOneClearLine) {
  EXPECT_THAT(names("combine = \"zip\"\n[vary]\nrope.tubes = [7, 7, 19]\nrope.length_nm = [20, 30, 30]\n"),
              ElementsAre("tubes-7_length_nm-20", "tubes-7_length_nm-30", "tubes-19_length_nm-30"));
  const std::pair<const char*, const char*> wrong[] = {
      {"combine = \"zip\"\n[vary]\nrope.tubes = [7, 7]\nrope.length_nm = [20, 20]\n", "two points would be named"},
      {"[threshold]\nkey = \"a.b\"\nfrom = 3\nto = 4\nabove = 1\nshape = \"helix\"\n",
       "above: stands beside shape"},
      {"[threshold]\nkey = \"a.b\"\nfrom = 3\nto = 4\nshape = \"helx\"\n", "helix"},
      {"", "vary: is missing or empty"},
      {"[vary]\nrope.tubes = 7\n", "rope.tubes: is one value"},
      {"[vary]\nrope.tubes = []\n", "is an empty list"},
      {"[vary]\nrope.tubes = [7, 7]\n", "has a value twice"},
      {"[vary]\nrope.tubes = [8]\n", "point"},
      {"[vary]\nrope.tubs = [7]\n", "did you mean \"tubes\""},
      {"[vary]\nrope.tubes.x = [7]\n", "is not a table"},
      {"[vary]\ngrip.0.z = [\"free\"]\n", "point"},
      {"[vary]\nrope.tubes = { from = 1, to = 7 }\n", "needs either points or step"},
      {"[vary]\nrope.tubes = { from = 1, to = 7, points = 0.5 }\n", "whole number"},
      {"[vary]\nrope.length_nm = { from = 9, to = 7, step = 1 }\n", "does not lead"},
      {"[vary]\nrope.length_nm = { from = -9, to = 7, points = 3, log = true }\n", "positive ends"},
      {"[vary]\nrope.length_nm = { from = 9, to = 7, points = 3, steps = 1 }\n", "unknown key \"steps\""},
      {"combine = \"zip\"\n[vary]\nrope.tubes = [7, 19]\nrope.length_nm = [20]\n", "has 1 values"},
      {"replicates = 2\n[vary]\nstart.seed = [7]\n", "is varied twice"},
      {"vari = 2\n[vary]\nrope.tubes = [7]\n", "vari: unknown key"},
      {"[branch]\nat_ps = 3\n", "varies nothing"},
      {"[threshold]\nfrom = 3\nto = 4\nabove = 1\n", "threshold.key: is missing"},
      {"[threshold]\nkey = \"a.b\"\nfrom = 3\nto = 3\nabove = 1\n", "is not above from"},
      {"[threshold]\nkey = \"a.b\"\nfrom = 3\nto = 4\nabove = 1\nbelow = 2\n", "threshold.below: unknown key"},
      {"[vary]\nrope.length_nm = { from = 1, to = 2, points = 90000 }\nstart.seed = [1, 2]\n", "at most 100000"}};
  for (const auto& [text, words] : wrong) {
    const std::string line = refusal(text);
    EXPECT_THAT(line, HasSubstr(words)) << text;
    EXPECT_EQ(line.find('\n'), std::string::npos) << line;
  }
}

// The program reads every sweep of data/campaigns and data/reproduction.
TEST(Campaigns, ShippedSweepsAreRead) {
  int sweeps = 0;
  for (const char* folder : {"/data/campaigns", "/data/reproduction"})
    for (const auto& entry : fs::recursive_directory_iterator(std::string(ROPEWALK_SOURCE_DIR) + folder)) {
      const std::string path = entry.path().string();
      if (entry.path().extension() != ".toml" || path.find("/runs/") != std::string::npos) continue;
      std::ifstream file(path);
      const std::string text((std::istreambuf_iterator<char>(file)), {});
      if (text.find("ropewalk-sweep-1") == std::string::npos) continue;
      SCOPED_TRACE(path);
      ++sweeps;
      EXPECT_FALSE(points_of(read_sweep(path)).empty());
    }
  EXPECT_GE(sweeps, 9);
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
