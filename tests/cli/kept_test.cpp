// Runs of earlier versions, as they left them (tests/data), under every verb of this one.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include "cli/support.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

using test::Outcome;
using test::slurp;
using test::spit;
using ::testing::HasSubstr;
namespace fs = test::fs;

class Kept : public test::Cli {};

TEST_F(Kept, RunsOfEarlierVersionsAreReadOrRefusedByName) {
  int versions = 0;
  for (const auto& version : fs::directory_iterator(ROPEWALK_SOURCE_DIR "/tests/data")) {
    if (!version.is_directory()) continue;
    ++versions;
    const std::string name = version.path().filename().string();
    SCOPED_TRACE(name);
    fs::remove_all(dir / "r");
    fs::copy(version.path() / "run", dir / "r", fs::copy_options::recursive);
    spit(dir / "again.toml",
         "format = \"ropewalk-scene-1\"\nparameters = \"r/parameters.toml\"\n[state]\nfile = \"r/final.csv\"\n"
         "[[friction]]\nstrength_pN_per_nm = 20\n[run]\nduration_ps = 0.02\n");
    for (const char* arguments :
         {"observe r", "report r", "view r -o v.html --force", "picture r -o p.svg", "compare r r",
          "convert r f.lammpstrj --force", "cite r", "calibrate show r/parameters.toml",
          "energy r/final.csv --parameters r/parameters.toml", "check again.toml",
          "run again.toml --out again --force --quiet"}) {
      const Outcome o = run(arguments);
      EXPECT_EQ(o.code, 0) << arguments << ": " << o.err;
    }
    const Outcome o = run("resume r --quiet");
    if (o.code == 0) continue;
    EXPECT_EQ(o.code, 2) << o.err;
    EXPECT_THAT(o.err, HasSubstr("version")) << o.err;
  }
  EXPECT_GE(versions, 1);
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
