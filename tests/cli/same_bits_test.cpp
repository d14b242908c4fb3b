// The same bits on any number of threads and after a resume, on scenes that are large enough to run in parallel,
// with every instruction set of the machine.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <regex>
#include <set>

#include "cli/support.hpp"
#include "io/files.hpp"
#include "sim/state/state.hpp"

namespace ropewalk::test {
namespace {
namespace UNIT {

struct BitsScene {
  const char* name;
  std::string text;
};
void PrintTo(const BitsScene& s, std::ostream* out) { *out << s.name; }

std::string scene(const char* set, const char* source, const char* rest) {
  return fmt::format("format = \"ropewalk-scene-1\"\nparameters = \"{}\"\n{}\n{}[run]\nduration_ps = 0.32\n{}", set,
                     source, rest, "log_every_ps = 0.08\nframes_every_ps = 0.16\ntime_step_fs = 4\n");
}

constexpr const char* rope = "[rope]\ntubes = 37\nlength_nm = 24.5";
constexpr const char* warm =
    "[thermostat]\ntemperature_K = 300\ncoupling_per_ps = 1\n[damping]\ncontact_viscosity_eV_ps_per_nm2 = 0\n"
    "bond_damping_per_ps = 0\n";

const std::vector<BitsScene> scenes = {
    {"LineLaw", scene("cnt-10-10-tersoff", rope, warm)},
    {"LineLawInDouble",
     scene("cnt-10-10-tersoff", rope,
           "[contact]\nprecision = \"double\"\n[start]\ntemperature_K = 300\nmay_cool = true\n")},
    {"PaperLaw", scene("cnt-10-10-paper", rope, warm)},
    {"Film", scene("cnt-10-10-tersoff", "[film]\ntubes = 40\nlength_nm = 22\nwidth_nm = 60\ndepth_nm = 40", "")},
};

class SameBits : public Cli, public ::testing::WithParamInterface<BitsScene> {
 protected:
  // Names of parametrised tests have a slash.
  void SetUp() override {
    dir = fs::temp_directory_path() / fmt::format("ropewalk-bits-{}-{}", GetParam().name, getpid());
    fs::create_directories(dir);
    spit(dir / "s.toml", GetParam().text);
  }

  // The hash of the state at the end, in all its digits, and of the frames.
  std::string hash_after(const std::string& arguments) const {
    const Outcome o = run(arguments + " --quiet");
    EXPECT_EQ(o.code, 0) << arguments << o.err;
    const std::string out = std::regex_replace(arguments, std::regex("^.*(?:--out|resume) (\\S+).*$"), "$1");
    return hash_hex(slurp(dir / out / "final.csv"));
  }
};

TEST_P(SameBits, OnAnyThreadsAndAfterAResume) {
  const std::string one = hash_after("run s.toml --out one --threads 1");
  const std::string frames = slurp(dir / "one/frames.gsd"), state = slurp(dir / "one/final.csv");
  EXPECT_GT(static_cast<std::size_t>(std::count(state.begin(), state.end(), '\n')), parallel_from + 1)
      << "not in parallel";
  for (const int threads : {2, 3})
    EXPECT_EQ(hash_after(fmt::format("run s.toml --out threads-{0} --threads {0}", threads)), one) << threads;
  EXPECT_EQ(slurp(dir / "threads-3/frames.gsd"), frames);
  EXPECT_NE(hash_after("run s.toml --out parts --threads 3 --steps 37"), one);
  EXPECT_EQ(hash_after("resume parts --threads 2"), one);
}

class SameBitsOfSets : public SameBits {};

TEST_P(SameBitsOfSets, WithEveryInstructionSet) {
  const std::vector<std::string> sets = instruction_sets_of_help();
  ASSERT_FALSE(sets.empty());
  std::set<std::string> hashes;
  for (const std::string& set : sets) {
    const std::string one =
        hash_after(fmt::format("run s.toml --out {0} --threads 1 --steps 40 --instructions {0}", set));
    EXPECT_EQ(
        hash_after(fmt::format("run s.toml --out {0}-3 --threads 3 --steps 20 --instructions {0}", set)).size(),
        16u);
    // By itself it goes on with the set that it was begun with.
    EXPECT_EQ(hash_after(fmt::format("resume {}-3 --threads 2 --steps 40", set)), one) << set;
    hashes.insert(one);
  }
  EXPECT_TRUE(hashes.size() > 1 || sets.size() == 1) << "the option changes nothing";
}

std::string name_of(const ::testing::TestParamInfo<BitsScene>& info) { return info.param.name; }

INSTANTIATE_TEST_SUITE_P(Scenes, SameBits, ::testing::ValuesIn(scenes), name_of);
INSTANTIATE_TEST_SUITE_P(Scenes, SameBitsOfSets, ::testing::Values(scenes[0], scenes[2]), name_of);

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk::test
