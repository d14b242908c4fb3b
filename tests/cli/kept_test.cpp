// Runs of earlier versions, as they left them (tests/data), under every verb of this one.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>

#include "cli/support.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

using test::Outcome;
using test::slurp;
using test::spit;
using ::testing::HasSubstr;
namespace fs = test::fs;

class Kept : public test::Cli {
 protected:
  // What a folder of a version holds, under every verb; `r` is a copy.
  void run_is_read(const fs::path& kept) {
    fs::remove_all(dir / "r");
    fs::copy(kept, dir / "r", fs::copy_options::recursive);
    // Forces with a memory, which the state brings along.
    const std::string scene = slurp(kept / "scene.toml");
    const std::size_t forces = std::min(scene.find("[["), scene.find("[run]"));
    spit(dir / "again.toml",
         "format = \"ropewalk-scene-1\"\nparameters = \"r/parameters.toml\"\n[state]\nfile = \"r/final.csv\"\n" +
             scene.substr(forces, scene.find("[run]") - forces) + "[run]\nduration_ps = 0.02\n");
    const std::string version = kept.parent_path().filename().string();
    const auto reads = [&](const char* arguments, bool may_refuse) {
      const Outcome o = run(arguments);
      if (may_refuse && o.code == 2)
        EXPECT_THAT(o.err, HasSubstr("ropewalk " + version)) << arguments;
      else
        EXPECT_EQ(o.code, 0) << arguments << ": " << o.err;
    };
    for (const char* arguments :
         {"observe r", "convert r f.lammpstrj --force", "cite r", "calibrate show r/parameters.toml",
          "atoms r -o r.xyz --force", "energy r/final.csv --parameters r/parameters.toml", "check again.toml",
          "run again.toml --out again --force --quiet"})
      reads(arguments, false);
    // The log of 0.2.0 has other columns.
    for (const char* arguments :
         {"report r", "view r -o v.html --force", "picture r -o p.svg --force", "compare r r --force"})
      reads(arguments, version == "0.2.0");
    reads("resume r --quiet", true);
  }
};

const char* const data = ROPEWALK_SOURCE_DIR "/tests/data";

TEST_F(Kept, RunsOfEarlierVersionsAreReadOrRefusedByName) {
  int runs = 0;
  for (const auto& file : fs::recursive_directory_iterator(data)) {
    if (file.path().filename() != "manifest.json") continue;
    SCOPED_TRACE(file.path());
    ++runs;
    run_is_read(file.path().parent_path());
  }
  EXPECT_GE(runs, 3);
}

TEST_F(Kept, ScenesOfEarlierVersionsAreRead) {
  int scenes = 0;
  for (const auto& file : fs::recursive_directory_iterator(data)) {
    if (file.path().parent_path().filename() != "scenes") continue;
    ++scenes;
    const std::string name = file.path().stem().string();
    // The others take seconds to be built.
    const bool small = name == "chain" || name == "bundle" || name == "hot-chain";
    const Outcome o = run(fmt::format(small ? "check '{}'" : "run '{}' --out never --wall-time 60 --slurm job.sh --force",
                                      file.path().string()));
    EXPECT_EQ(o.code, 0) << name << ": " << o.err;
  }
  EXPECT_GE(scenes, 8);
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
