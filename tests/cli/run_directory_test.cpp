// The directory of a run: one process at a time, no foreign scene, signals of batch systems, the same bits
// elsewhere.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <regex>

#include "cli/support.hpp"
#include "io/log.hpp"
#include "signals.hpp"

namespace ropewalk::test {
namespace {
namespace UNIT {

using ::testing::HasSubstr;
using Json = nlohmann::json;

class RunDirectoryOf : public Cli {
 protected:
  void scene(const std::string& name, const std::string& run_keys, const std::string& rest = "") const {
    spit(dir / name, "format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-paper\"\n[chain]\nelements = 5\n" +
                         rest + "[run]\ntime_step_fs = 20\n" + run_keys);
  }
  void scene_without_end() const {
    scene("s.toml", "duration_ps = 1e7\nlog_every_ps = 1000\nframes_every_ps = 1e5\n");
  }

  // Commands of a shell with a run in the background, whose id is in $pid once it is at work.
  Outcome beside_a_run(const std::string& arguments, const std::string& commands,
                       const std::string& before = "") const {
    const SignalsOfATerminal signals;
    spit(dir / "script.sh", fmt::format("{4}cd '{0}'\n'{1}' {2} > run.txt 2>&1 &\npid=$!\n"
                                        "for k in $(seq 600); do [ -e d/limits.json ] && break; sleep 0.05; done\n"
                                        "sleep 0.1\n{3}\n",
                                        dir.string(), ROPEWALK_PROGRAM, arguments, commands, before));
    const int status =
        std::system(("bash '" + (dir / "script.sh").string() + "' > '" + (dir / "stdout.txt").string() +
                     "' 2> '" + (dir / "stderr.txt").string() + "' < /dev/null")
                        .c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 1000, slurp(dir / "stdout.txt"), slurp(dir / "stderr.txt")};
  }
  Json manifest() const { return Json::parse(slurp(dir / "d/manifest.json")); }
};

TEST_F(RunDirectoryOf, OneProcessIsTheOnlyOne) {
  scene_without_end();
  const Outcome o =
      beside_a_run("run s.toml --out d --quiet",
                   fmt::format("for words in 'resume d' 'run s.toml --out d --force'; do\n'{}' $words; "
                               "echo code $? of $words\ndone\necho holder $pid\nkill -TERM $pid\nwait $pid",
                               ROPEWALK_PROGRAM));
  EXPECT_EQ(o.code, 128 + SIGTERM);
  EXPECT_THAT(o.out, HasSubstr("code 2 of resume d\n"));
  EXPECT_THAT(o.out, HasSubstr("code 2 of run s.toml --out d --force\n"));
  const std::string holder = std::regex_replace(o.out, std::regex("[^]*holder ([0-9]+)\n[^]*"), "$1");
  EXPECT_EQ(std::count(o.err.begin(), o.err.end(), '\n'), 2) << o.err;
  EXPECT_THAT(o.err, HasSubstr("ropewalk: d: is in use by process " + holder + " on ")) << o.err;
  EXPECT_EQ(manifest().at("status"), "interrupted");
  EXPECT_FALSE(fs::exists(dir / "d/lock"));
  // A process that was killed holds nothing.
  spit(dir / "d/lock", "process 1 on nowhere since ever");
  EXPECT_EQ(run("resume d --quiet --steps " + std::to_string(manifest().at("steps").get<long>() + 5)).code, 0)
      << slurp(dir / "stderr.txt");
}

TEST_F(RunDirectoryOf, SignalsOfBatchSystems) {
  scene_without_end();
  for (const auto& [name, number] : {std::pair{"HUP", SIGHUP}, std::pair{"XCPU", SIGXCPU},
                                     std::pair{"USR1", SIGUSR1}, std::pair{"USR2", SIGUSR2}}) {
    const Outcome o =
        beside_a_run("run s.toml --out d --quiet --force", fmt::format("kill -{} $pid\nwait $pid", name));
    EXPECT_EQ(o.code, 128 + number) << name << o.err;
    EXPECT_EQ(manifest().at("status"), "interrupted") << name;
    EXPECT_FALSE(fs::exists(dir / "d/final.csv")) << name;
    fs::remove_all(dir / "d");
  }
  // nohup has HUP ignored, and it stays so.
  const Outcome o = beside_a_run("run s.toml --out d --quiet",
                                 "kill -HUP $pid\nsleep 0.3\nkill -TERM $pid\nwait $pid", "trap '' HUP\n");
  EXPECT_EQ(o.code, 128 + SIGTERM) << o.err;
}

TEST_F(RunDirectoryOf, AFileBeyondTheLimitOnSizesIsAnError) {
  scene("s.toml", "duration_ps = 1e7\nlog_every_ps = 0.1\n");
  spit(dir / "script.sh",
       fmt::format("ulimit -f 64\ncd '{}' && '{}' run s.toml --out d --quiet", dir.string(), ROPEWALK_PROGRAM));
  const int status = std::system(
      ("bash '" + (dir / "script.sh").string() + "' 2> '" + (dir / "stderr.txt").string() + "'").c_str());
  EXPECT_EQ(WEXITSTATUS(status), 3);
  const std::string said = slurp(dir / "stderr.txt");
  EXPECT_THAT(said, HasSubstr("log.csv: cannot be written: File too large"));
  EXPECT_THAT(said, HasSubstr("go on with: ropewalk resume d"));
  const long steps = ropewalk::read_log((dir / "d/log.csv").string()).size();
  EXPECT_GT(steps, 50);
}

TEST_F(RunDirectoryOf, StopsBeforeTheWallTime) {
  scene_without_end();
  Outcome o = run("run s.toml --out d --quiet --wall-time 2");
  EXPECT_EQ(o.code, 6) << o.err;
  EXPECT_THAT(o.err, HasSubstr("stopped by --wall-time at"));
  EXPECT_EQ(manifest().at("status"), "interrupted");
  const long steps = manifest().at("steps");
  o = run("resume d --quiet --wall-time 0:00:01");
  EXPECT_EQ(o.code, 6) << o.err;
  EXPECT_GT(manifest().at("steps").get<long>(), steps);
  for (const char* wrong : {"soon", "0", "1:00", "1:60:00", "-5"}) {
    o = run(fmt::format("run s.toml --out never --wall-time={}", wrong));
    EXPECT_EQ(o.code, 2) << wrong;
    EXPECT_EQ(std::count(o.err.begin(), o.err.end(), '\n'), 1) << o.err;
  }
  EXPECT_FALSE(fs::exists(dir / "never"));
}

TEST_F(RunDirectoryOf, AForeignSceneIsRefused) {
  const std::string damping = "[damping]\nbond_damping_per_ps = 1\n";
  scene("s.toml", "duration_ps = 2\n", damping);
  ASSERT_EQ(run("run s.toml --out d --quiet --until 1").code, 0);
  const std::string text = slurp(dir / "d/scene.toml"), log = slurp(dir / "d/log.csv"),
                    set = slurp(dir / "d/parameters.toml");
  const auto replaced = [&](const std::string& what, const std::string& by) {
    std::string out = text;
    out.replace(out.find(what), what.size(), by);
    spit(dir / "d/scene.toml", out);
  };
  const auto expect_refused = [&](const std::string& words) {
    const Outcome o = run("resume d --quiet");
    EXPECT_EQ(o.code, 2) << words;
    EXPECT_EQ(std::count(o.err.begin(), o.err.end(), '\n'), 1) << o.err;
    EXPECT_THAT(o.err, HasSubstr("ropewalk: d: is not what the run was begun with: " + words));
    EXPECT_THAT(o.err, HasSubstr("--accept-changes"));
    EXPECT_EQ(slurp(dir / "d/log.csv"), log);
  };
  replaced("damping_per_ps = 1", "damping_per_ps = 2");
  expect_refused("damping.bond_damping_per_ps: 1 -> 2");
  replaced(damping, "");
  expect_refused("damping.bond_damping_per_ps: 1 -> not set");
  spit(dir / "d/scene.toml", text);
  spit(dir / "d/parameters.toml", set + "# mine\n");
  expect_refused("parameters.toml is another one");
  spit(dir / "d/parameters.toml", set);
  // Comments do not count, and a longer run is only said.
  replaced("duration_ps = 2", "duration_ps = 3  # longer");
  fs::copy(dir / "d", dir / "longer", fs::copy_options::recursive);
  Outcome o = run("resume longer --quiet");
  EXPECT_EQ(o.code, 0) << o.err;
  EXPECT_THAT(o.err, HasSubstr("note: changed since the run was begun: run.duration_ps: 2 -> 3\n"));
  EXPECT_NEAR(ropewalk::read_log((dir / "longer/log.csv").string()).back()["time_ps"], 3, 0.02);
  // Asked for, everything goes, and is then what the run is made of; the end is that of the scene, whatever the
  // step.
  replaced("time_step_fs = 20", "time_step_fs = 10");
  o = run("resume d --quiet --accept-changes");
  EXPECT_EQ(o.code, 0) << o.err;
  EXPECT_THAT(o.err, HasSubstr("run.time_step_fs: 20 -> 10"));
  EXPECT_THAT(o.err, HasSubstr("the time step stays 20 fs"));
  EXPECT_NEAR(ropewalk::read_log((dir / "d/log.csv").string()).back()["time_ps"], 2, 0.021);
  EXPECT_EQ(run("resume d --quiet").code, 0) << slurp(dir / "stderr.txt");
}

// A run keeps the friction that it was begun with, whatever becomes of the user's file.
TEST_F(RunDirectoryOf, FilesOfFrictionAreKept) {
  const auto quantity = [](const char* key, const char* unit) {
    return fmt::format("{} = {{ value = 0.05, unit = \"{}\", standard_error = 0, origin = \"chosen\" }}\n", key, unit);
  };
  spit(dir / "friction-mine.toml",
       "[meta]\nformat = \"ropewalk-friction-1\"\nname = \"friction-mine\"\nchirality_a = [10, 10]\nchirality_b = [10, "
       "10]\npotential = \"none\"\n[friction]\n" +
           quantity("strength", "pN/nm") + quantity("spin_strength", "pN/nm") + quantity("end_strength", "pN") +
           quantity("elastic_slip", "nm") + quantity("drag", "eV ps/nm^3") + "[provenance]\n");
  for (const char* from : {"friction-mine", "friction-mine.toml", "atoms"}) {
    SCOPED_TRACE(from);
    scene("s.toml", "duration_ps = 2\n", fmt::format("[[friction]]\nfrom = \"{}\"\n", from));
    Outcome o = run("run s.toml --out d --force --quiet --until 1");
    ASSERT_EQ(o.code, 0) << o.err;
    const std::string kept = slurp(dir / "d/friction-0.toml");
    EXPECT_EQ(kept, slurp(dir / "friction-mine.toml"));
    fs::rename(dir / "friction-mine.toml", dir / "away.toml");
    spit(dir / "d/friction-0.toml", kept + "# mine\n");
    o = run("resume d --quiet");
    EXPECT_EQ(o.code, 2);
    EXPECT_THAT(o.err, HasSubstr("friction-*.toml"));
    spit(dir / "d/friction-0.toml", kept);
    o = run("resume d --quiet");
    EXPECT_EQ(o.code, 0) << o.err;
    fs::rename(dir / "away.toml", dir / "friction-mine.toml");
  }
}

TEST_F(RunDirectoryOf, InstructionsAreKept) {
  scene("s.toml", "duration_ps = 1\n");
  const std::vector<std::string> sets = instruction_sets_of_help();
  ASSERT_FALSE(sets.empty());
  const std::string other = sets.back();  // the narrowest, which every processor has
  ASSERT_EQ(run("run s.toml --out d --quiet --until 0.5 --instructions " + other).code, 0)
      << slurp(dir / "stderr.txt");
  EXPECT_EQ(manifest().at("instructions"), other);
  ASSERT_EQ(run("resume d --quiet").code, 0) << slurp(dir / "stderr.txt");
  EXPECT_EQ(manifest().at("instructions"), other);
  const Outcome o = run("resume d --quiet --until 1.5 --instructions " + sets.front());
  EXPECT_EQ(o.code, 0) << o.err;
  EXPECT_EQ(manifest().at("instructions"), sets.front());
  EXPECT_THAT(o.err, HasSubstr(sets.size() > 1 ? other + " -> " + sets.front() : ""));
  EXPECT_EQ(run("run s.toml --out e --instructions ABACUS").code, 2);
}

TEST_F(RunDirectoryOf, LeftOverPartsBlockNothing) {
  scene("s.toml", "duration_ps = 0.5\n");
  ASSERT_EQ(run("run s.toml --out d --quiet").code, 0);
  const auto leave_parts = [&] {
    for (const char* name : {"checkpoint.bin.part-123-0", "manifest.json.part-9-12"})
      spit(dir / "d" / name, "half");
  };
  leave_parts();
  EXPECT_EQ(run("resume d --quiet").code, 0) << slurp(dir / "stderr.txt");
  EXPECT_FALSE(fs::exists(dir / "d/checkpoint.bin.part-123-0"));
  leave_parts();
  EXPECT_EQ(run("run s.toml --out d --quiet --force").code, 0) << slurp(dir / "stderr.txt");
  EXPECT_FALSE(fs::exists(dir / "d/manifest.json.part-9-12"));
  spit(dir / "d/thesis.tex.part-1-2", "mine");
  EXPECT_EQ(run("run s.toml --out d --quiet --force").code, 2);
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk::test
