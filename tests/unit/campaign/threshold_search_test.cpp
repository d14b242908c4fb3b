// A search takes the trials of an earlier one.
#include "campaign/threshold_search.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

namespace ropewalk {
namespace {
namespace UNIT {

namespace fs = std::filesystem;

class ThresholdSearches : public ::testing::Test {
 protected:
  void SetUp() override {
    dir = fs::temp_directory_path() / ("ropewalk-threshold-search-" + std::to_string(getpid()));
    fs::create_directories(dir);
    write("tube.toml",
          "format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-paper\"\n[rope]\ntubes = 1\nlength_nm = 13.56\n"
          "[twist]\nmoment_nN_nm = 5\nrate_nN_nm_per_ps = 5\nhold_ps = 1\n");
    write("s.toml",
          "format = \"ropewalk-sweep-1\"\nscene = \"tube.toml\"\nreplicates = 2\n[threshold]\n"
          "key = \"twist.moment_nN_nm\"\nfrom = 2\nto = 20\ncolumn = \"rotation_deg\"\nabove = 20\naccuracy = 0.1\n"
          "[vary]\nrope.length_nm = { from = 10, to = 48, points = 20 }\n");
  }
  void TearDown() override { fs::remove_all(dir); }

  void write(const std::string& name, const std::string& text) const { std::ofstream(dir / name) << text; }
  std::string path(const std::string& name) const { return (dir / name).string(); }

  fs::path dir;
};

// 40 points; 20 000 trials are of the last of them, and 30 000 of another scene.
TEST_F(ThresholdSearches, TakesManyTrials) {
  const Sweep sweep = read_sweep(path("s.toml"));
  const std::vector<SweepPoint> points = points_of(sweep);
  ASSERT_EQ(points.size(), 40u);
  constexpr int own = 20000, foreign = 30000;
  std::string table = key_cells(sweep, sweep.keys()) + column_names(trial_columns()) + "\n";
  const auto row = [&](const SweepPoint& p, double value, bool passed, const std::string& hash) {
    table += key_cells(sweep, p.values) + fmt::format("1,{:.6g},{},{},nan,nan,0,straight,,nan,{}\n", value,
                                                      passed ? 1 : 0, passed ? "3" : "nan", hash);
  };
  const TrialHashes hashes(sweep, points.back());
  for (int k = 0; k < own; ++k) {
    const double value = 2 + 1e-3 * k;
    row(points.back(), value, value > 10, hashes.of(value));
  }
  for (int k = 0; k < foreign; ++k)
    row(points[static_cast<std::size_t>(k) % 40], 3, false, fmt::format("{:016x}", k));
  write("trials.csv", table);

  ThresholdSearch search(sweep, campaign_directory(path("s.toml"), path("out")));
  search.begin(false);
  const auto [others, all] = search.take(path("trials.csv"));
  const std::string words = search.words_of(points.back());
  EXPECT_EQ(all, static_cast<std::size_t>(own + foreign));
  EXPECT_EQ(others, static_cast<std::size_t>(foreign));
  EXPECT_NE(words.find(": 10 to 10"), std::string::npos) << words;
}

// A table of a sweep with other keys: its trials are known by their scenes.
TEST_F(ThresholdSearches, TakesTrialsOfASweepWithOtherKeys) {
  const Sweep sweep = read_sweep(path("s.toml"));
  const std::vector<SweepPoint> points = points_of(sweep);
  write("trials.csv", "rope.tubes,seed,value,passed,at_ps,scene_xxh64\n1,1,4,0,nan," +
                          trial_hash(sweep, points[7], 4) + "\n1,1,4,0,nan,0123456789abcdef\n");
  ThresholdSearch search(sweep, campaign_directory(path("s.toml"), path("out")));
  search.begin(false);
  EXPECT_EQ(search.take(path("trials.csv")), std::pair(std::size_t{1}, std::size_t{2}));
  EXPECT_NE(search.words_of(points[7]).find("at none of the values tried"), std::string::npos);
  EXPECT_NE(search.words_of(points[8]).find("no run ended"), std::string::npos);
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
