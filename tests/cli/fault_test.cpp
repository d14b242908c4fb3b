// A program killed at any of its calls that change files, or with any of these calls failing (tests/faults):
// nothing is lost, and a resumed run is byte for byte that of an undisturbed one.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <thread>

#include "cli/support.hpp"
#include "io/frames/gsd.hpp"

namespace ropewalk::test {
namespace {
namespace UNIT {

using ::testing::HasSubstr;

// Its account of energy does not close in the end, so that it goes back and divides its steps.
constexpr const char* lively =
    "format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-paper\"\n[chain]\nelements = 4\n"
    "[twist]\nmoment_nN_nm = 5\nrate_nN_nm_per_ps = 5\nhold_ps = 1\n[limits]\nspeed_nm_per_ps = 1e-5\n"
    "[run]\nlog_every_ps = 0.2\nframes_every_ps = 0.5\ncheckpoint_every_s = 1e-6\n";
constexpr const char* calm =
    "format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-paper\"\n[chain]\nelements = 4\n"
    "[start]\ntemperature_K = 300\nmay_cool = true\n[run]\nduration_ps = 0.25\ntime_step_fs = 5\n"
    "log_every_ps = 0.025\nframes_every_ps = 0.05\ncheckpoint_every_s = 1e-6\n";

class Faults : public Cli {
 protected:
  // In memory where that is possible: thousands of files are written to the disk here.
  void SetUp() override {
    Cli::SetUp();
    if (fs::exists("/dev/shm")) {
      fs::remove_all(dir);
      dir = fs::path("/dev/shm") / dir.filename();
      fs::create_directories(dir);
    }
    spit(dir / "s.toml", lively);
  }

  Outcome with(const std::string& fault, const std::string& arguments) const {
    return run(arguments, fmt::format("env LD_PRELOAD='{}' OMP_NUM_THREADS=1 GOMP_SPINCOUNT=0 "
                                      "ROPEWALK_FAULTS_BELOW='{}' ROPEWALK_FAULT={} ROPEWALK_FAULTS_COUNT='{}' "
                                      "ROPEWALK_FAULTS_MADE='{}'",
                                      ROPEWALK_FAULTS, (dir / "d").string(), fault, (dir / "count").string(),
                                      (dir / "made").string()));
  }

  long calls_of(const std::string& arguments, const std::string& fault = "none:0") const {
    EXPECT_EQ(with(fault, arguments).code, 0) << slurp(dir / "stderr.txt");
    return std::stol("0" + slurp(dir / "count"));
  }

  // Every call, or every few of them unless the environment has ROPEWALK_ALL_FAULTS.
  static long stride(long usual) { return std::getenv("ROPEWALK_ALL_FAULTS") ? 1 : usual; }
  static long first(long usual) { return 1 + stride(usual) * cases_of_this_run().first; }
  static long step(long usual) { return stride(usual) * cases_of_this_run().step; }

  void expect_same(const fs::path& a, const fs::path& b, const std::string& when) const {
    for (const char* name : {"log.csv", "frames.gsd", "final.csv", "limits.json"})
      EXPECT_TRUE(slurp(dir / a / name) == slurp(dir / b / name) && fs::exists(dir / b / name))
          << when << ": " << name;
    EXPECT_THAT(slurp(dir / b / "manifest.json"), HasSubstr("\"finished\"")) << when;
    for (const auto& entry : fs::directory_iterator(dir / b))
      EXPECT_EQ(entry.path().string().find(".part-"), std::string::npos) << when << ": " << entry.path();
  }

  // Lines that name the fault, and no raw text of a library.
  void expect_clear(const Outcome& o, const std::string& when) const {
    EXPECT_THAT(o.code, ::testing::AnyOf(0, 2, 3)) << when << o.err;
    EXPECT_EQ(o.code == 0 || !o.err.empty(), true) << when;
    std::istringstream lines(o.err);
    for (std::string line; std::getline(lines, line);)
      EXPECT_EQ(line.rfind("ropewalk", 0), 0u) << when << ": " << line;
    EXPECT_EQ(o.err.find("std::"), std::string::npos) << when << ": " << o.err;
  }

  void begin(const fs::path& from) const {
    fs::remove_all(dir / "d");
    if (!from.empty()) fs::copy(dir / from, dir / "d", fs::copy_options::recursive);
  }

  // After whatever happened to it.
  void bring_to_its_end(const std::string& command, const std::string& reference, const std::string& when) const {
    const bool begun = fs::exists(dir / "d/checkpoint.bin") || fs::exists(dir / "d/checkpoint-before.bin");
    const Outcome on = run("resume d --quiet");
    if (begun) {
      ASSERT_EQ(on.code, 0) << when << ": " << on.err;
    } else {
      EXPECT_EQ(on.code, 2) << when;
      EXPECT_EQ(std::count(on.err.begin(), on.err.end(), '\n'), 1) << when << ": " << on.err;
      const Outcome anew = run(command + " --force");
      ASSERT_EQ(anew.code, 0) << when << ": " << anew.err;
    }
    expect_same(reference, "d", when);
    EXPECT_FALSE(fs::exists(dir / "d/lock")) << when;
  }

  // `from`: the directory as it is before the command; empty: none.
  void kill_everywhere(const std::string& how, const std::string& command, const fs::path& from,
                       const std::string& reference, long usual_stride = 1) const {
    begin(from);
    const long calls = calls_of(command);
    ASSERT_GT(calls, 40);
    int tried = 0;
    for (long n = first(usual_stride); n <= calls; n += step(usual_stride)) {
      const std::string when = fmt::format("{} at call {} of {} of {}", how, n, calls, command);
      begin(from);
      const Outcome o = with(fmt::format("{}:{}", how, n), command);
      if (how != "kill" && o.code == 0) {  // torn: not a write; term: it was at its end
        expect_same(reference, "d", when);
        continue;
      }
      EXPECT_NE(o.code, 0) << when;
      bring_to_its_end(from.empty() ? command : "", reference, when);
      if (HasFatalFailure()) return;
      ++tried;
    }
    fmt::print("{} in {}: {} tried\n", how, command, tried);
  }

  void fail_everywhere(const std::string& how, bool on, const std::string& command, const fs::path& from,
                       const std::string& reference, long usual_stride = 1) const {
    begin(from);
    const long calls = calls_of(command);
    int tried = 0;
    for (long n = first(usual_stride); n <= calls; n += step(usual_stride)) {
      const std::string when =
          fmt::format("{}{} at call {} of {} of {}", how, on ? " from" : "", n, calls, command);
      begin(from);
      const Outcome o = with(fmt::format("{}:{}{}", how, n, on ? ":on" : ""), command);
      expect_clear(o, when);
      EXPECT_TRUE(o.code == 0 || how != "EINTR") << when << o.err;
      if (o.code == 0 && !on)
        expect_same(reference, "d", when);
      else
        bring_to_its_end(from.empty() ? command : "", reference, when);
      if (HasFatalFailure()) return;
      ++tried;
    }
    fmt::print("{}{} in {}: {} tried\n", how, on ? ", from then on," : ", once,", command, tried);
  }

  static constexpr const char* run_it = "run s.toml --out d --quiet";
  static constexpr const char* go_on = "resume d --quiet";

  // `whole`: not disturbed. `half` ends in the middle, `halves` has gone on from there.
  void references(bool halves) const {
    ASSERT_EQ(run("run s.toml --out whole --quiet").code, 0) << slurp(dir / "stderr.txt");
    if (!halves) return;
    ASSERT_EQ(run("run s.toml --out half --quiet --steps 20").code, 0);
    fs::copy(dir / "half", dir / "halves", fs::copy_options::recursive);
    ASSERT_EQ(run("resume halves --quiet").code, 0);
  }
};

TEST_F(Faults, RunKilledAtAnyCall) {
  references(false);
  kill_everywhere("kill", run_it, "", "whole");
}

TEST_F(Faults, RunKilledInAnyWrite) {
  references(false);
  kill_everywhere("torn", run_it, "", "whole");
}

TEST_F(Faults, RunToldToStopAtAnyCall) {
  references(false);
  kill_everywhere("term", run_it, "", "whole", 3);
}

TEST_F(Faults, ResumeKilledAtAnyCall) {
  references(true);
  kill_everywhere("kill", go_on, "half", "halves");
}

// With checkpoints on the way.
TEST_F(Faults, RelaxationEndedAtAnyCall) {
  spit(dir / "s.toml",
       "format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-paper\"\n[chain]\nelements = 8\n[[load]]\n"
       "kind = \"torque\"\nelements = [0]\ntorque_nN_nm = [0, -20, 0]\n[[load]]\nkind = \"torque\"\n"
       "elements = [-1]\ntorque_nN_nm = [0, 20, 0]\n[run]\nmode = \"relax\"\n"
       "checkpoint_every_s = 1e-6\n");
  references(false);
  kill_everywhere("kill", run_it, "", "whole", 3);
  kill_everywhere("term", run_it, "", "whole", 5);
}

TEST_F(Faults, DiskFullFromAnyCallOfARun) {
  references(false);
  fail_everywhere("ENOSPC", true, run_it, "", "whole");
}

TEST_F(Faults, DiskFullFromAnyCallOfAResume) {
  references(true);
  fail_everywhere("EDQUOT", true, go_on, "half", "halves");
}

TEST_F(Faults, AnyCallOfARunFailsOnce) {
  references(true);
  fail_everywhere("EIO", false, run_it, "", "whole");
  fail_everywhere("ENOSPC", false, go_on, "half", "halves", 3);
}

TEST_F(Faults, SignalsInAnyCallAreOfNoConsequence) {
  references(false);
  fail_everywhere("EINTR", false, run_it, "", "whole", 2);
}

// Requests for memory are many and of one kind: some of them, spread over the run. The first ones are of libraries,
// before main() begins. One that fails once is of no consequence.
TEST_F(Faults, MemoryRunsOut) {
  spit(dir / "s.toml", calm);
  references(false);
  const auto chosen = static_cast<long>(std::getenv("ROPEWALK_ALL_FAULTS") ? 2000 : 25), before_main = 1000L;
  begin("");
  const long requests = calls_of(run_it, "memory:0");
  ASSERT_GT(requests, 2 * before_main);
  for (const bool on : {false, true}) {
    int tried = 0, ended = 0;
    for (long k = 1; k <= chosen; ++k, ++tried) {
      const long n = before_main + (requests - before_main) * k / (chosen + 1);
      const std::string when =
          fmt::format("request {} of {}{}", n, requests, on ? " and all large ones after it" : "");
      begin("");
      const Outcome o = with(fmt::format("memory:{}{}", n, on ? ":on" : ""), run_it);
      expect_clear(o, when);
      if (o.code == 0) {
        expect_same("whole", "d", when);
      } else {
        EXPECT_TRUE(on) << when << o.err;
        EXPECT_THAT(o.err, HasSubstr("memory")) << when;
        bring_to_its_end(run_it, "whole", when);
        ++ended;
      }
      if (HasFatalFailure()) return;
    }
    EXPECT_EQ(ended > 0, on);
    fmt::print("no memory{} in {}: {} tried, {} ended by it\n", on ? ", from then on," : ", once,", run_it, tried,
               ended);
  }
}

// As FAT, CIFS and some file systems of FUSE.
TEST_F(Faults, FileSystemsWithoutFlushesOrPermissions) {
  ASSERT_EQ(run("run s.toml --out whole --quiet").code, 0);
  for (const auto& [call, code, words] : {std::tuple{"fdatasync", "EINVAL", "does not flush files to the disk"},
                                          std::tuple{"fchmod", "EPERM", "keeps no permissions"}}) {
    fs::remove_all(dir / "d");
    const Outcome o = run("run s.toml --out d --quiet",
                          fmt::format("env LD_PRELOAD='{}' OMP_NUM_THREADS=1 ROPEWALK_FAULTS_BELOW='{}' "
                                      "ROPEWALK_FAULT={}:1:on ROPEWALK_FAULTS_CALL={}",
                                      ROPEWALK_FAULTS, (dir / "d").string(), code, call));
    EXPECT_EQ(o.code, 0) << call << o.err;
    const std::size_t at = o.err.find(words);
    EXPECT_NE(at, std::string::npos) << call << o.err;
    EXPECT_EQ(o.err.find(words, at + 1), std::string::npos) << "once: " << o.err;
    expect_same("whole", "d", call);
  }
}

// A driver of FAT, fusefat, refuses to cut a file to the length that it has, so that a run that ends at a checkpoint
// must go on without a cut.
TEST_F(Faults, ARunGoesOnWhereFilesAreNotCutToTheirOwnLength) {
  spit(dir / "s.toml", calm);
  ASSERT_EQ(run("run s.toml --out whole --quiet").code, 0);
  for (const char* command : {"run s.toml --out d --quiet --until 0.1", "resume d --quiet"}) {
    const Outcome o = run(command, fmt::format("env LD_PRELOAD='{}' OMP_NUM_THREADS=1 ROPEWALK_FAULTS_BELOW='{}' "
                                               "ROPEWALK_FAULT=EPERM:1:on ROPEWALK_FAULTS_CALL=ftruncate",
                                               ROPEWALK_FAULTS, (dir / "d").string()));
    EXPECT_EQ(o.code, 0) << command << ": " << o.err;
  }
  expect_same("whole", "d", "without cuts");
}

TEST_F(Faults, ReadOnlyFileSystem) {
  references(true);
  for (const char* command : {run_it, go_on}) {
    begin(command == go_on ? "half" : "");
    const Outcome o = with("EROFS:1:on", command);
    EXPECT_EQ(o.code, 2) << o.err;
    EXPECT_EQ(std::count(o.err.begin(), o.err.end(), '\n'), 1) << o.err;
    EXPECT_THAT(o.err, HasSubstr("the file system is read-only"));
  }
}

// The same command goes on, and its table is that of a sweep that was left alone.
TEST_F(Faults, SweepKilledAndGoneOnWith) {
  spit(dir / "w.toml", "format = \"ropewalk-sweep-1\"\nscene = \"s.toml\"\n[vary]\ntwist.moment_nN_nm = [2, 3]\n");
  const std::string sweep = "sweep w.toml --quiet -j 1 --out ";
  ASSERT_EQ(run(sweep + "whole").code, 0) << slurp(dir / "stderr.txt");
  const std::string table = slurp(dir / "whole/table.csv");
  long n = first(11);
  int tried = 0;
  for (;; n += step(11), ++tried) {
    fs::remove_all(dir / "d");
    const Outcome o = with(fmt::format("kill:{}", n), sweep + "d");
    if (o.code == 0) break;  // there are no more calls
    const Outcome on = run(sweep + "d");
    ASSERT_EQ(on.code, 0) << n << ": " << on.err;
    ASSERT_EQ(slurp(dir / "d/table.csv"), table) << n;
  }
  EXPECT_GT(n, 100);
  fmt::print("kill in sweep: {} tried\n", tried);
}

// Verbs around a run, each killed, or with the disk full, at some of its calls. The same command then does its
// work, and what it leaves is that of a command that was left alone.
TEST_F(Faults, OtherVerbsKilledOrOutOfDisk) {
  spit(dir / "s.toml", calm);
  ASSERT_EQ(run("run s.toml --out ready --quiet").code, 0) << slurp(dir / "stderr.txt");
  struct Verb {
    const char *command, *result;
    long stride;
  };
  for (const Verb& verb :
       {Verb{"convert d d/c.lammpstrj --force", "d/c.lammpstrj", 3},
        Verb{"convert d d/c.pvd --force", "d/c.pvd", 7}, Verb{"view d --force", "d/view.html", 2},
        Verb{"report d", "d/report.html", 2}, Verb{"export ready --lammps d --force", "d/rope.state", 5}}) {
    const std::string command = verb.command, name = command.substr(0, command.find(' '));
    const bool of_a_run = command.find(" d ") == name.size() || command == "report d";
    const auto prepare = [&] { begin(of_a_run ? "ready" : ""); };
    const auto result = [&] {
      const std::string text = slurp(dir / verb.result);
      return name == "view" ? std::to_string(text.size()) : text;  // its nonce is new each time
    };
    prepare();
    calls_of(command);
    const std::string whole = result();
    EXPECT_FALSE(whole.empty()) << command << slurp(dir / "stderr.txt");
    int tried = 0;
    for (const char* how : {"kill:{}", "ENOSPC:{}:on"})
      for (long n = first(verb.stride);; n += step(verb.stride), ++tried) {
        const std::string fault = fmt::format(fmt::runtime(how), n), when = fault + " in " + command;
        prepare();
        const Outcome o = with(fault, command);
        if (std::string(how).rfind("kill", 0) != 0) expect_clear(o, when);
        if (o.code != 0) {
          const Outcome again = run(command);
          EXPECT_EQ(again.code, 0) << when << ": " << again.err;
        }
        EXPECT_TRUE(result() == whole) << when;
        if (HasFailure()) return;
        if (o.code == 0) break;
      }
    fmt::print("kill and full disk in {}: {} tried\n", command, tried);
  }
}

// Files that belong together are all there, or none is.
TEST_F(Faults, AtomsWithoutRoomLeaveNoneOfTheirFiles) {
  spit(dir / "s.toml", calm);
  ASSERT_EQ(run("run s.toml --out ready --quiet").code, 0) << slurp(dir / "stderr.txt");
  setenv("ROPEWALK_FAULTS_CALL", "write", 1);
  for (long n = 1;; ++n) {
    fs::remove_all(dir / "d");
    fs::create_directories(dir / "d");
    const Outcome o = with(fmt::format("ENOSPC:{}:on", n), "atoms ready -o d/a.data");
    if (o.code == 0) {
      EXPECT_GT(n, 2);
      EXPECT_TRUE(fs::exists(dir / "d/a.data") && fs::exists(dir / "d/a-elements.csv"));
      break;
    }
    EXPECT_EQ(o.code, 2) << o.err;
    EXPECT_TRUE(fs::is_empty(dir / "d")) << n;
  }
  unsetenv("ROPEWALK_FAULTS_CALL");
}

TEST_F(Faults, ACoarsenWithoutRoomDoesNotStandInItsOwnWay) {
  spit(dir / "t.toml",
       "format = \"ropewalk-scene-1\"\nparameters = \"cnt-5-5-tersoff\"\n[rope]\ntubes = 1\nlength_nm = 4\n"
       "[run]\nduration_ps = 0.02\n");
  ASSERT_EQ(run("run t.toml --out ready --quiet").code, 0) << slurp(dir / "stderr.txt");
  ASSERT_EQ(run("atoms ready -o t.xyz").code, 0);
  ASSERT_EQ(run("coarsen t.xyz -o whole --quiet").code, 0);
  setenv("ROPEWALK_FAULTS_CALL", "write", 1);
  long n = 1;
  for (; with(fmt::format("ENOSPC:{}:on", n), "coarsen t.xyz -o d --quiet").code != 0; ++n) {
    ASSERT_LT(n, 100);
    for (const auto& entry : fs::directory_iterator(dir / "d")) ADD_FAILURE() << n << ": " << entry.path();
  }
  unsetenv("ROPEWALK_FAULTS_CALL");
  EXPECT_GT(n, 3);
  EXPECT_EQ(slurp(dir / "d/log.csv"), slurp(dir / "whole/log.csv"));
}

// A verb that starts processes of its own, killed in whichever of them, or with the disk full from a call on. Its
// files are whole or not there, the same command then ends as if it had been left alone, and leaves no temporary
// folder.
struct VerbOfProcesses {
  std::string command;
  std::vector<std::string> results;  // below d
  std::function<void()> prepare;     // d before the command
  long stride;
  std::function<std::string(const std::string&)> comparable = [](const std::string& text) { return text; };
  int code = 0;       // of the command that is left alone
  bool once = false;  // it does not write over what it has made
  // Calls of a command that takes seconds, counted from its end where negative; with ROPEWALK_ALL_FAULTS every
  // `stride`th.
  std::vector<long> chosen = {};
};

class FaultsOfProcesses : public Faults {
 protected:
  void SetUp() override {
    Faults::SetUp();
    setenv("TMPDIR", (dir / "d/t").c_str(), 1);
  }
  void TearDown() override {
    for (const char* name :
         {"TMPDIR", "LMP_AGAIN", "ROPEWALK_LMP", "ROPEWALK_FAULTS_TOGETHER", "ROPEWALK_FAULTS_CALL"})
      unsetenv(name);
    Faults::TearDown();
  }

  std::set<std::string> temporary_folders() const {
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(dir / "d/t"))
      if (const std::string name = entry.path().filename().string(); name.rfind("ompi.", 0) != 0)  // of Open MPI
        names.insert(name);
    return names;
  }

  bool has_work_folder() const {
    const fs::recursive_directory_iterator all(dir / "d");
    return std::any_of(fs::begin(all), fs::end(all), [](const fs::directory_entry& entry) {
      return entry.path().filename().string().rfind("work-", 0) == 0;
    });
  }

  // Of all commands but the first, LAMMPS is what it left for the same input before.
  void remember_lammps() const {
    fs::create_directories(dir / "lmp");
    setenv("LMP_AGAIN", (dir / "lmp").c_str(), 1);
    setenv("ROPEWALK_LMP", ROPEWALK_SOURCE_DIR "/tests/faults/lmp_again", 1);
  }

  void break_off_everywhere(const VerbOfProcesses& verb) const {
    const auto prepare = [&] {
      verb.prepare();
      fs::create_directories(dir / "d/t");
      fs::remove(dir / "made");
    };
    const auto result = [&](const std::string& name) { return verb.comparable(slurp(dir / "d" / name)); };
    prepare();
    const Outcome alone = with("none:0", verb.command);
    const long calls = std::stol("0" + slurp(dir / "count"));
    ASSERT_EQ(alone.code, verb.code) << verb.command << alone.err;
    EXPECT_EQ(alone.err, "") << verb.command;
    std::vector<std::string> whole;
    for (const std::string& name : verb.results) {
      whole.push_back(result(name));
      ASSERT_FALSE(whole.back().empty()) << name;
    }
    EXPECT_TRUE(temporary_folders().empty()) << verb.command;
    const bool chosen = !verb.chosen.empty() && stride(2) == 2;
    const long apart = verb.chosen.empty() ? stride(verb.stride) : verb.stride;
    int tried = 0;
    for (const char* how : {"kill:{}", "ENOSPC:{}:on"})
      for (std::size_t k = 0; !chosen || k < verb.chosen.size(); ++k, ++tried) {
        const long n = !chosen              ? 1 + static_cast<long>(k) * apart
                       : verb.chosen[k] < 0 ? calls + 1 + verb.chosen[k]
                                            : verb.chosen[k];
        const std::string fault = fmt::format(fmt::runtime(how), n), when = fault + " in " + verb.command;
        prepare();
        const Outcome o = with(fault, verb.command);
        if (!fs::exists(dir / "made") && !chosen) break;
        EXPECT_TRUE(fs::exists(dir / "made")) << when;
        // Processes whose parent was killed end by themselves.
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
        if (std::string(how).rfind("kill", 0) != 0) expect_clear(o, when);
        EXPECT_EQ(o.out.find("not ended"), std::string::npos) << when << ": " << o.out;
        bool made = true;
        for (std::size_t k = 0; k < whole.size(); ++k) {
          made = made && fs::exists(dir / "d" / verb.results[k]);
          if (fs::exists(dir / "d" / verb.results[k]) && !of_a_failure(verb.results[k])) {
            EXPECT_TRUE(result(verb.results[k]) == whole[k]) << when << ": " << verb.results[k];
          }
        }
        const std::set<std::string> left = temporary_folders();
        if (std::string(how).rfind("kill", 0) != 0) {
          EXPECT_THAT(left, ::testing::IsEmpty()) << when;
          EXPECT_FALSE(has_work_folder()) << when;
        }
        if (!(verb.once && made)) {
          const Outcome again = run(verb.command);
          EXPECT_EQ(again.code, verb.code) << when << ": " << o.err << again.err;
        }
        for (std::size_t k = 0; k < whole.size(); ++k)
          EXPECT_TRUE(result(verb.results[k]) == whole[k]) << when << ", gone on with: " << verb.results[k];
        EXPECT_EQ(temporary_folders(), left) << when;
        EXPECT_FALSE(has_work_folder()) << when;
        if (HasFailure()) return;
      }
    EXPECT_GT(tried, 1) << verb.command;
    fmt::print("kill and full disk in {}: {} tried\n", verb.command, tried);
  }

  // Files that a broken command may leave different from those of an undisturbed one: tables and pages of the
  // points that have ended, and the results of a case that was killed, which name the failure.
  static bool of_a_failure(const std::string& name) {
    return name.find("w/t") == 0 || name.find(".json") != std::string::npos ||
           name.find("report.html") != std::string::npos || name.find("tubes.csv") != std::string::npos;
  }
};

TEST_F(FaultsOfProcesses, ThresholdBrokenOff) {
  spit(dir / "tube.toml",
       "format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-paper\"\n[rope]\ntubes = 1\nlength_nm = 6.78\n"
       "[damping]\nbond_damping_per_ps = 4\n[twist]\nmoment_nN_nm = 5\nrate_nN_nm_per_ps = 5\nhold_ps = 1\n[run]\n"
       "log_every_ps = 0.2\n");
  spit(
      dir / "w.toml",
      "format = \"ropewalk-sweep-1\"\nscene = \"tube.toml\"\n[threshold]\nkey = \"twist.moment_nN_nm\"\nfrom = 18\n"
      "to = 20\ncolumn = \"rotation_deg\"\nabove = 20\naccuracy = 0.2\n");
  break_off_everywhere({"threshold w.toml --out d/w -j 1 --quiet",
                        {"w/thresholds.csv", "w/trials.csv", "w/thresholds.html"},
                        [&] { begin(""); },
                        25});
}

TEST_F(FaultsOfProcesses, ErrorsBrokenOff) {
  spit(dir / "s.toml", std::regex_replace(std::string(calm), std::regex("paper"), "tersoff"));
  ASSERT_EQ(run("run s.toml --out ready --quiet").code, 0) << slurp(dir / "stderr.txt");
  break_off_everywhere({"errors d --quiet -j 1",
                        {"errors.csv", "errors-potential.csv", "errors/errors.json", "report.html"},
                        [&] { begin("ready"); },
                        19});
}

// The set is there, and the results of all cases but one.
TEST_F(FaultsOfProcesses, ParametrizeBrokenOff) {
  const std::string name = "cnt-5-5-tersoff", of_one = "euler-buckling";
  fs::create_directories(dir / "ready/p");
  for (const char* file : {".toml", "-stiffness.csv", "-contact.csv"})
    fs::copy(ROPEWALK_SOURCE_DIR "/data/parameters/" + name + file, dir / "ready/p");
  const std::string folder = "ready/p/" + name + "-validation";
  ASSERT_EQ(run("validate run " + of_one + " --parameters ready/p/" + name + ".toml --quiet --out " + folder).code,
            0)
      << slurp(dir / "stderr.txt");
  nlohmann::ordered_json result = nlohmann::ordered_json::parse(slurp(dir / folder / (of_one + ".json")));
  const auto cases = nlohmann::json::parse(run("validate list --json").out);
  for (const auto& one : cases) {
    result["case"] = one.at("name");
    spit(dir / folder / (one.at("name").get<std::string>() + ".json"), result.dump(1) + "\n");
  }
  fs::remove(dir / folder / (of_one + ".json"));
  const auto without_times = [](const std::string& text) {
    return std::regex_replace(text, std::regex("[0-9.]+ s\\b|,[0-9.]+,[0-9.]+\n"), "");
  };
  break_off_everywhere({"parametrize 5,5 --out d/p --friction none --budget 0.001 -j 1 --quiet",
                        {"p/report.html", "p/tubes.csv"},
                        [&] { begin("ready"); },
                        6,
                        without_times});
}

// The last calls give the two tables and the set their names, one after another. The command gives no --force.
TEST_F(FaultsOfProcesses, CalibrationBrokenOff) {
  remember_lammps();
  break_off_everywhere({"calibrate --chirality 8,0 --quiet --out d/p.toml",
                        {"p.toml", "p-stiffness.csv", "p-contact.csv"},
                        [&] { begin(""); },
                        5,
                        [](const std::string& text) { return text; },
                        0,
                        true,
                        {-4}});
}

// LAMMPS does not look whether its files are written. File systems of so many KiB are the disk of TMPDIR; that of
// MPI has room.
TEST_F(FaultsOfProcesses, ACalibrationOnDisksThatLammpsFills) {
  fs::create_directories(dir / "d/t");
  fs::create_directories(dir / "mpi");
  spit(dir / "on_a_small_disk.sh",
       "mount -t tmpfs -o size=$1k none d/t || exit 99\nshift\n\"$@\"\ncode=$?\nls d/t > left.txt\nexit $code\n");
  const auto on_a_disk_of = [&](int KiB, const std::string& command) {
    return run(command, fmt::format("env OMPI_MCA_orte_tmpdir_base='{}' unshare -rm sh on_a_small_disk.sh {}",
                                    (dir / "mpi").string(), KiB));
  };
  if (const Outcome o = on_a_disk_of(4, "--version"); o.code != 0)
    GTEST_SKIP() << "nothing can be mounted: " << o.err;
  for (const int KiB : {4, 30, 80, 300}) {
    const Outcome o = on_a_disk_of(KiB, "calibrate --chirality 8,0 --quiet --out d/p.toml");
    EXPECT_THAT(o.code, ::testing::AnyOf(2, 3)) << KiB;
    EXPECT_EQ(std::count(o.err.begin(), o.err.end(), '\n'), 1) << KiB << o.err;
    EXPECT_THAT(o.err, HasSubstr("free some space")) << KiB;
    EXPECT_EQ(slurp(dir / "left.txt"), "") << KiB << o.err;
    EXPECT_EQ(o.out, "") << KiB;
    for (const char* name : {"p.toml", "p-stiffness.csv", "p-contact.csv"})
      EXPECT_FALSE(fs::exists(dir / "d" / name));
  }
}

// References of atoms, and a case with them.
TEST_F(FaultsOfProcesses, ValidationWithAtomsBrokenOff) {
  remember_lammps();
  const std::string name = "cnt-6-6-tersoff";
  fs::create_directories(dir / "ready/p");
  for (const char* file : {".toml", "-stiffness.csv", "-contact.csv"})
    fs::copy(ROPEWALK_SOURCE_DIR "/data/parameters/" + name + file, dir / "ready/p");
  // A reference that was made is a stored one the next time.
  const auto comparable = [](const std::string& text) {
    return std::regex_replace(
        text, std::regex("# wall_seconds: .*|\"seconds\": [0-9.e+-]+|\\((fresh|stored)[^\"]*\""), "");
  };
  break_off_everywhere(
      {"validate run pair-distance --atoms --parameters d/p/" + name + ".toml --out d/v -j 1 --quiet",
       {"p/" + name + "-atoms/pair-distance.csv", "v/report.json"},
       [&] { begin("ready"); },
       1,
       comparable,
       0,
       false,
       {2, 5, 12, 40, 136}});
}

// A full disk before the first checkpoint: one line, exit code 3, and nothing stands in the way of the same
// command.
TEST_F(Faults, DiskFullBeforeTheFirstCheckpoint) {
  const long calls = calls_of(run_it);
  for (long n = 3; n < std::min(calls, 40L); n += 2) {
    begin("");
    const Outcome o = with(fmt::format("ENOSPC:{}", n), run_it);
    if (o.code == 0 || fs::exists(dir / "d/checkpoint.bin")) continue;
    EXPECT_EQ(o.code, 3) << n << o.err;
    EXPECT_EQ(std::count(o.err.begin(), o.err.end(), '\n'), 1) << n << o.err;
    EXPECT_THAT(o.err, ::testing::Not(HasSubstr("last checkpoint"))) << n;
    EXPECT_THAT(o.err, ::testing::Not(HasSubstr("resume"))) << n;
    EXPECT_THAT(o.err, HasSubstr("give the same command again")) << n;
    EXPECT_FALSE(fs::exists(dir / "d")) << n;
    ASSERT_EQ(run(run_it).code, 0) << n << slurp(dir / "stderr.txt");
  }
}

// A run that splits its elements goes on in a second directory. After a kill, `resume` of either directory goes on.
TEST_F(Faults, RefinedRunKilledAndGoneOnWith) {
  spit(dir / "s.toml",
       "format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-tersoff\"\n[chain]\nelements = 6\n[contact]\n"
       "law = \"none\"\n[twist]\nmoment_nN_nm = 14\nrate_nN_nm_per_ps = 7\nhold_ps = 1\n[limits]\ntwist_deg = 2\n"
       "[run]\nlog_every_ps = 0.25\nframes_every_ps = 1\ncheckpoint_every_s = 1e-6\n");
  const std::string refine = " --quiet --on-limit refine";
  const auto clear = [&] {
    for (const char* name : {"d", "d.fine"}) fs::remove_all(dir / name);
  };
  const long calls = calls_of("run s.toml --out d" + refine);
  ASSERT_TRUE(fs::exists(dir / "d.fine/final.csv"));
  fs::rename(dir / "d", dir / "coarse");
  fs::rename(dir / "d.fine", dir / "whole");
  int tried = 0;
  for (long n = first(5); n <= calls; n += step(5), ++tried) {
    clear();
    with(fmt::format("kill:{}", n), "run s.toml --out d" + refine);
    Outcome o = run("resume d" + refine);
    if (o.code == 2 && o.err.find("go on with: ropewalk resume d.fine") != std::string::npos)
      o = run("resume d.fine" + refine);
    else if (o.code == 2 && o.err.find("there is no checkpoint") != std::string::npos)
      o = run("run s.toml --force --out d" + refine);
    ASSERT_EQ(o.code, 0) << n << ": " << o.err;
    for (const char* name : {"log.csv", "frames.gsd", "final.csv", "limits.json"}) {
      ASSERT_TRUE(slurp(dir / "d.fine" / name) == slurp(dir / "whole" / name)) << n << ": " << name;
      ASSERT_TRUE(slurp(dir / "d" / name) == slurp(dir / "coarse" / name)) << n << ": " << name << " of the first";
    }
  }
  fmt::print("kill in a refined run: {} tried\n", tried);
}

// Files lose their tails, as by a power cut before they reach the disk, or by users who make room.
TEST_F(Faults, LostTails) {
  spit(dir / "s.toml", calm);
  references(true);
  const auto size = [&](const char* name) { return fs::file_size(dir / "half" / name); };
  const auto resumed = [&](const std::string& remark) {
    const Outcome o = run(go_on);
    ASSERT_EQ(o.code, 0) << o.err;
    EXPECT_THAT(o.err, HasSubstr(remark));
  };
  // Behind the newest checkpoint but not behind the one before.
  for (const char* name : {"log.csv", "frames.gsd"}) {
    begin("half");
    fs::resize_file(dir / "d" / name, size(name) - 1);
    resumed("the run goes on from the checkpoint before");
    expect_same("whole", "d", name);
  }
  // Lengthened again by a file system that had only the size on the disk.
  begin("half");
  fs::resize_file(dir / "d/log.csv", size("log.csv") - 30);
  fs::resize_file(dir / "d/log.csv", size("log.csv"));
  resumed("is not what was written up to the checkpoint");
  expect_same("whole", "d", "a tail of zeros");
  // Frames are done without.
  begin("half");
  fs::resize_file(dir / "d/frames.gsd", 100);
  resumed("frames begin anew here");
  EXPECT_EQ(slurp(dir / "d/log.csv"), slurp(dir / "halves/log.csv"));
  EXPECT_TRUE(ropewalk::is_gsd((dir / "d/frames.gsd").string()));
  begin("half");
  fs::remove(dir / "d/frames.gsd");
  resumed("frames.gsd is missing");
  EXPECT_EQ(run("observe d").code, 0) << slurp(dir / "stderr.txt");
  begin("half");
  const ropewalk::GsdReader frames((dir / "half/frames.gsd").string());
  const auto second = std::find_if(frames.entries().begin(), frames.entries().end(),
                                   [](const ropewalk::GsdEntry& e) { return e.frame == 1; });
  fs::resize_file(dir / "d/frames.gsd", static_cast<std::uintmax_t>(second->location) + 50);
  resumed("frames go on behind the last whole one");
  const ropewalk::GsdReader mended((dir / "d/frames.gsd").string());
  EXPECT_GE(mended.count(), 2u);
  EXPECT_EQ(mended.entries()[static_cast<std::size_t>(second - frames.entries().begin())].location,
            second->location);
  EXPECT_EQ(run("observe d").code, 0) << slurp(dir / "stderr.txt");
  // A log is not.
  begin("half");
  fs::resize_file(dir / "d/log.csv", 2000);
  const std::string log = slurp(dir / "d/log.csv");
  const Outcome o = run(go_on);
  EXPECT_EQ(o.code, 2);
  EXPECT_EQ(std::count(o.err.begin(), o.err.end(), '\n'), 1) << o.err;
  EXPECT_THAT(o.err, HasSubstr("log.csv: has 2000 of the"));
  EXPECT_THAT(o.err, HasSubstr("bring it back from a copy, or start the run anew"));
  EXPECT_EQ(slurp(dir / "d/log.csv"), log) << "nothing is written";
}

TEST_F(Faults, DamagedCheckpoints) {
  spit(dir / "s.toml", calm);
  references(true);
  const auto damage = [&](const char* name) {
    std::string bytes = slurp(dir / "d" / name);
    bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
    spit(dir / "d" / name, bytes);
  };
  begin("half");
  damage("checkpoint.bin");
  Outcome o = run(go_on);
  EXPECT_EQ(o.code, 0) << o.err;
  EXPECT_THAT(o.err, HasSubstr("checkpoint.bin is damaged"));
  expect_same("whole", "d", "the newer damaged");
  begin("half");
  fs::remove(dir / "d/checkpoint.bin");
  EXPECT_EQ(run(go_on).code, 0);
  expect_same("whole", "d", "the newer missing");
}

// Under cron and daemons; the first file opened must not take the number of a standard stream.
TEST_F(Faults, ClosedStandardStreams) {
  references(true);
  for (const char* closed : {"2>&-", ">&-", "<&-", "<&- >&- 2>&-"}) {
    begin("");
    const std::string in = fmt::format("cd '{}' && '{}' ", dir.string(), ROPEWALK_PROGRAM);
    ASSERT_EQ(std::system((in + "run s.toml --out d " + closed).c_str()), 0) << closed;
    expect_same("whole", "d", closed);
    begin("half");
    ASSERT_EQ(std::system((in + "resume d " + closed).c_str()), 0) << closed;
    expect_same("halves", "d", closed);
  }
}

// Messages that cannot be written end nothing.
TEST_F(Faults, NobodyCanReadTheMessages) {
  references(false);
  for (const char* to : {"2> /dev/full", "2> /dev/full > /dev/full"}) {
    begin("");
    const std::string in = fmt::format("cd '{}' && '{}' ", dir.string(), ROPEWALK_PROGRAM);
    const int status = std::system((in + "run s.toml --out d " + to).c_str());
    ASSERT_TRUE(WIFEXITED(status)) << to;
    expect_same("whole", "d", to);
  }
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk::test
