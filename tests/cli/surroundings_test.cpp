// What stands around a run: directories that come from somebody else, folders full of other people's files, and
// campaigns that several processes work in. Nothing outside is read, written or removed, and nothing hangs.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <sys/stat.h>

#include <algorithm>
#include <map>
#include <regex>
#include <set>

#include "cli/support.hpp"

namespace ropewalk::test {
namespace {
namespace UNIT {

using ::testing::AnyOf;
using ::testing::HasSubstr;
using ::testing::Not;

class Surroundings : public Cli {
 protected:
  void SetUp() override {
    Cli::SetUp();
    spit(dir / "s.toml", scene());
  }

  static std::string scene(const std::string& run_keys = "duration_ps = 0.4\nlog_every_ps = 0.1\n") {
    return "format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-tersoff\"\n[chain]\nelements = 4\n[start]\n"
           "temperature_K = 300\nmay_cool = true\n[run]\nframes_every_ps = 0.1\n" +
           run_keys;
  }

  // Exit code 1000: it did not end.
  Outcome soon(const std::string& arguments, const std::string& before = "") const {
    return run(arguments, before + " timeout -s KILL 180");
  }

  // Names, kinds and contents of everything in a folder.
  std::map<std::string, std::string> content(const fs::path& folder) const {
    std::map<std::string, std::string> all;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
      const fs::file_status status = entry.symlink_status();
      const std::string name = entry.path().lexically_relative(folder).string();
      all[name] = fs::is_symlink(status)        ? "-> " + fs::read_symlink(entry.path()).string()
                  : fs::is_regular_file(status) ? slurp(entry.path())
                  : fs::is_directory(status)    ? "directory"
                                                : "other";
    }
    return all;
  }

  // The script is killed after four minutes.
  Outcome script(const std::string& commands) const {
    spit(dir / "script.sh", fmt::format("cd '{}'\nPATH='{}':$PATH\n{}\n", dir.string(),
                                        fs::path(ROPEWALK_PROGRAM).parent_path().string(), commands));
    const int status = std::system(
        fmt::format("timeout 240 bash '{0}/script.sh' > '{0}/stdout.txt' 2> '{0}/stderr.txt'", dir.string())
            .c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 1000, slurp(dir / "stdout.txt"), slurp(dir / "stderr.txt")};
  }

  void sweep_file(const std::string& rest, const std::string& of = "s.toml") const {
    spit(dir / "w.toml", "format = \"ropewalk-sweep-1\"\nscene = \"" + of + "\"\n" + rest);
  }
};

const char* const verbs_of_a_run[] = {"resume h --quiet",   "report h",
                                      "view h --force",     "observe h",
                                      "picture h -o p.svg", "convert h c.gsd --force",
                                      "compare h whole",    "export h --lammps e --force",
                                      "errors h --quiet",   "check h --accuracy --stretch 0.01",
                                      "import h",           "run s.toml --out h --force --quiet",
                                      "gather h",           "convert h h/v.pvd --force"};

// Each file of a run in turn is a link to a file outside, a pipe that nobody writes to, or another name of a file
// outside.
TEST_F(Surroundings, AHostileRunDirectoryReachesNothingOutside) {
  ASSERT_EQ(run("run s.toml --out whole --quiet").code, 0) << slurp(dir / "stderr.txt");
  ASSERT_EQ(run("run s.toml --out half --quiet --until 0.2").code, 0);
  fs::create_directories(dir / "outside/folder");
  std::vector<std::string> names = {"lock", "errors", "v", "view.html", "changed.toml"};
  for (const auto& entry : fs::directory_iterator(dir / "half")) names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  const std::string mine = "mine, and nobody else's\n";
  const Cases tried = cases_of_this_run();
  long number = 0;
  for (const std::string& name : names)
    for (const char* kind : {"link", "pipe", "name"}) {
      spit(dir / "outside/file", mine);
      const auto before = content(dir / "outside");
      for (const char* verb : verbs_of_a_run) {
        if (number++ % tried.step != tried.first) continue;
        fs::remove_all(dir / "h");
        fs::copy(dir / "half", dir / "h", fs::copy_options::recursive);
        const fs::path hostile = dir / "h" / name;
        const bool folder = name == "errors" || name == "v";
        fs::remove(hostile);
        if (kind == std::string("link"))
          fs::create_symlink(folder ? "../outside/folder" : "../outside/file", hostile);
        else if (kind == std::string("pipe"))
          ASSERT_EQ(::mkfifo(hostile.c_str(), 0644), 0);
        else
          fs::create_hard_link(dir / "outside/file", hostile);
        const std::string when = fmt::format("{} as a {}: {}", name, kind, verb);
        const Outcome o = soon(verb);
        EXPECT_THAT(o.code, AnyOf(0, 2, 3, 5, 7)) << when << "\n" << o.err;
        EXPECT_TRUE(content(dir / "outside") == before) << when << "\n" << o.err;
        EXPECT_EQ(o.err.find("std::"), std::string::npos) << when << "\n" << o.err;
        if (HasFailure()) return;
      }
    }
}

// Each verb on the directory of a run that is at work: it reads what is there, or says who is at work, and the run
// ends with the bytes of one that was left alone.
TEST_F(Surroundings, EachVerbBesideALivingRun) {
  std::string lasting = scene("duration_ps = 1000\nlog_every_ps = 2\n");
  lasting.replace(lasting.find("frames_every_ps = 0.1"), 21, "frames_every_ps = 50");
  spit(dir / "s.toml", lasting);
  const Outcome begun = script(
      "ropewalk run s.toml --out whole --quiet\n"
      "setsid ropewalk run s.toml --out h --quiet < /dev/null > run.out 2>&1 & echo $! > pid\n"
      "until [ \"$(cat h/log.csv 2> /dev/null | wc -l)\" -gt 20 ]; do kill -0 $(cat pid) || exit 9; done\n"
      "kill -STOP $(cat pid)\n");
  ASSERT_EQ(begun.code, 0) << begun.err << slurp(dir / "run.out");
  ASSERT_EQ(slurp(dir / "h/manifest.json").find("finished"), std::string::npos);
  std::set<std::string> refused;
  for (const char* verb : verbs_of_a_run) {
    const Outcome o = soon(verb);
    EXPECT_THAT(o.code, AnyOf(0, 2)) << verb << ": " << o.err;
    if (o.code == 2) refused.insert(std::string(verb).substr(0, std::string(verb).find(' ')));
  }
  for (const char* verb : {"resume", "run"}) EXPECT_EQ(refused.count(verb), 1u) << verb;
  ASSERT_EQ(script("kill -CONT $(cat pid); while kill -0 $(cat pid) 2> /dev/null; do sleep 0.02; done").code, 0);
  EXPECT_THAT(slurp(dir / "h/manifest.json"), HasSubstr("\"finished\"")) << slurp(dir / "run.out");
  for (const char* file : {"log.csv", "frames.gsd", "final.csv", "limits.json"})
    EXPECT_TRUE(slurp(dir / "h" / file) == slurp(dir / "whole" / file)) << file;
}

// What stands under the names that temporary files had, or have, stays as it is, and counts for nothing.
TEST_F(Surroundings, TemporaryPlacesOfOthersAreNeitherTakenNorHarmed) {
  ASSERT_EQ(run("run s.toml --out d --quiet").code, 0) << slurp(dir / "stderr.txt");
  sweep_file("[vary]\nstart.seed = [1, 2]\n");
  fs::create_directories(dir / "outside");
  spit(dir / "outside/file", "mine\n");
  // The errors of the models, whose times are new each time.
  const auto errors_of = [](const std::string& text) {
    std::multiset<std::string> rows;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);)
      if (line.find(" %") != std::string::npos)
        rows.insert(std::regex_replace(line, std::regex("[0-9]+\\.[0-9]+(?![0-9]| %)"), "T"));
    return rows;
  };
  for (const char* verb : {"sweep w.toml --dry-run", "convert d c.lammpstrj", "view d -o v.html"}) {
    // The number of the process is known before the program begins.
    const auto in_a_place = [&](const std::string& prepare) {
      for (const char* made : {"t", "c.lammpstrj", "v.html"}) fs::remove_all(dir / made);
      fs::create_directories(dir / "t");
      return script(fmt::format(
          "export TMPDIR=$PWD/t\n{}\nfind t -ls > before.txt\n"
          "bash -c 'echo > go; while [ -e go ]; do sleep 0.01; done; exec ropewalk {}' &\n"
          "pid=$!\nwhile [ ! -e go ]; do sleep 0.01; done\n"
          "for k in $(seq $pid $((pid + 40))); do id=$k; eval \"$PREPARE\"; done\n"
          "find t . -maxdepth 1 -name '*ropewalk-*' -o -name '*.part-*' | sort > there.txt\n"
          "rm go\nwait $pid\ncode=$?\n"
          "find t . -maxdepth 1 -name '*ropewalk-*' -o -name '*.part-*' | sort | cmp - there.txt || exit 9\n"
          "exit $code",
          prepare, verb));
    };
    const Outcome clean = in_a_place("PREPARE=:");
    ASSERT_EQ(clean.code, 0) << verb << clean.err;
    const Outcome beside = in_a_place(
        "PREPARE='for n in timing; do mkdir -p t/ropewalk-$n-$id; cp -r d t/ropewalk-$n-$id/0; "
        "ln -s ../../outside/file t/ropewalk-$n-$id/seconds; ln -s ../../outside/file t/ropewalk-$n-$id/0.txt; "
        "done; "
        "for n in c.lammpstrj v.html; do ln -s outside/file $n.part-$id; "
        "ln -s outside/file $n.part-$id-0; done'");
    EXPECT_EQ(beside.code, 0) << verb << beside.err;
    EXPECT_EQ(errors_of(beside.out), errors_of(clean.out)) << verb;
    EXPECT_EQ(slurp(dir / "outside/file"), "mine\n") << verb;
    for (const auto& entry : fs::directory_iterator(dir))
      if (entry.path().filename().string().find(".part-") != std::string::npos) fs::remove(entry.path());
  }
  // A place that cannot be used is said to be so.
  const std::string nowhere = (dir / "nowhere").string();
  const Outcome o = run("sweep w.toml --dry-run", "TMPDIR=" + nowhere);
  EXPECT_THAT(o.err, HasSubstr(nowhere)) << o.err;
}

TEST_F(Surroundings, AFolderBesideAMovieStays) {
  fs::create_directories(dir / "bin");
  for (const char* program : {"ffmpeg", "rsvg-convert"}) {
    spit(dir / "bin" / program,
         "#!/bin/sh\nfor last; do :; done\n[ \"$last\" = - ] && exit 0\n"
         "case $1 in -o) > $2;; *) echo movie > \"$last\";; esac\n");
    fs::permissions(dir / "bin" / program, fs::perms::owner_all);
  }
  ASSERT_EQ(run("run s.toml --out d --quiet").code, 0) << slurp(dir / "stderr.txt");
  fs::create_directories(dir / "m.webm.frames");
  spit(dir / "m.webm.frames/thesis.txt", "mine");
  const Outcome o = run("view d --movie m.webm --frames 2", "PATH=$PWD/bin:$PATH");
  ASSERT_EQ(o.code, 0) << o.err;
  EXPECT_EQ(slurp(dir / "m.webm.frames/thesis.txt"), "mine");
  EXPECT_EQ(slurp(dir / "m.webm"), "movie\n");
  for (const auto& entry : fs::directory_iterator(dir))
    EXPECT_EQ(entry.path().filename().string().rfind("ropewalk-", 0), std::string::npos) << entry.path();
}

// Beside a result, and where drafts of earlier versions stood.
TEST_F(Surroundings, ADraftTakesNoFileOfTheUser) {
  ASSERT_EQ(run("run s.toml --out d --quiet").code, 0) << slurp(dir / "stderr.txt");
  spit(dir / "fig.png.svg", "mine");
  ASSERT_EQ(run("picture d -o fig.png").code, 0) << slurp(dir / "stderr.txt");
  EXPECT_EQ(slurp(dir / "fig.png").substr(1, 3), "PNG");
  EXPECT_EQ(slurp(dir / "fig.png.svg"), "mine");

  fs::create_directories(dir / "d/errors");
  spit(dir / "d/errors/EA-plus.toml", "mine");
  ASSERT_EQ(run("errors d --quiet").code, 0) << slurp(dir / "stderr.txt");
  EXPECT_EQ(slurp(dir / "d/errors/EA-plus.toml"), "mine");

  sweep_file("[branch]\nat_ps = 0.2\n[branch.vary]\nrun.duration_ps = [0.4]\n");
  const std::string point = script("ropewalk sweep w.toml --quiet > /dev/null && ls w/points").out;
  ASSERT_NE(point, "") << slurp(dir / "stderr.txt");
  const std::string made = (dir / "w/points" / point.substr(0, point.find('\n'))).string(), mine = made + ".part",
                    left = made + ".part-12-3";
  fs::copy(dir / "d", mine, fs::copy_options::recursive);
  fs::rename(made, left);  // as a killed process leaves it
  const auto before = content(mine);
  ASSERT_EQ(run("sweep w.toml --quiet").code, 0) << slurp(dir / "stderr.txt");
  EXPECT_TRUE(fs::exists(made + "/final.csv"));
  EXPECT_TRUE(content(mine) == before);
  EXPECT_FALSE(fs::exists(left));
}

// The limit on the size of files stands for a full disk.
TEST_F(Surroundings, ThatThereIsNoRoomIsSaidAndNothingStays) {
  ASSERT_EQ(run("run s.toml --out d --quiet").code, 0) << slurp(dir / "stderr.txt");
  ASSERT_EQ(run("picture d -o d/whole.svg").code, 0) << slurp(dir / "stderr.txt");
  const auto room_for_svg = static_cast<int>(fs::file_size(dir / "d/whole.svg") / 1024 + 1);  // KiB
  fs::create_directories(dir / "bin");
  spit(dir / "bin/ffmpeg",
       "#!/bin/sh\nfor last; do :; done\n[ \"$last\" = - ] || head -c 1000000 /dev/zero > \"$last\"\n");
  fs::permissions(dir / "bin/ffmpeg", fs::perms::owner_all);
  const auto names = [&] {
    std::set<std::string> all;
    for (const auto& entry : fs::directory_iterator(dir)) all.insert(entry.path().filename().string());
    return all;
  };
  script("");
  const std::set<std::string> before = names();
  struct Case {
    int room;  // KiB
    const char *verb, *words;
  };
  for (const Case& c : {Case{1, "picture d -o f.png", "f.png: cannot be written: "},
                        Case{room_for_svg, "picture d -o f.png --zoom 8", "f.png: cannot be written: "},
                        Case{1, "view d --movie m.webm --frames 2", "m.webm: pictures cannot be written: "},
                        Case{500, "view d --movie m.webm --frames 2", "m.webm: cannot be written: "},
                        Case{1, "convert d c.pvd", ".vtp: cannot be written: "}}) {
    const Outcome o = script(fmt::format("PATH=$PWD/bin:$PATH\nulimit -f {}\nropewalk {}", c.room, c.verb));
    EXPECT_EQ(o.code, 2) << c.verb << o.err;
    EXPECT_THAT(o.err, HasSubstr(c.words + std::string("File too large; "))) << c.verb;
    EXPECT_EQ(names(), before) << c.verb;
  }
  // Another reason is not taken for a lack of room.
  const Outcome o = run("picture d -o f.png", "PATH=" + (dir / "nowhere").string());
  EXPECT_THAT(o.err, HasSubstr("f.png: -o: cannot be made: rsvg-convert is missing; ")) << o.err;
  EXPECT_EQ(names(), before);
}

// --force removes the files of a run by their names, also those in `errors`, and nothing if there is one more.
TEST_F(Surroundings, ForceRemovesWhatItKnowsByName) {
  ASSERT_EQ(run("run s.toml --out d --quiet").code, 0) << slurp(dir / "stderr.txt");
  const std::string again = "run s.toml --out d --quiet --force";
  for (const char* name : {"parameters-of-mine.toml", "errors/notes.txt", "errors/EA-plus/notes.txt",
                           "log.csv.part-of-mine", "frames.gsd.old"}) {
    fs::create_directories((dir / "d" / name).parent_path());
    spit(dir / "d" / name, "mine");
    const auto before = content(dir / "d");
    const Outcome o = run(again);
    EXPECT_EQ(o.code, 2) << name;
    EXPECT_THAT(o.err, HasSubstr(std::string("holds ") + name + ", which is not of a run")) << o.err;
    EXPECT_TRUE(content(dir / "d") == before) << name;
    fs::remove(dir / "d" / name);
  }
  spit(dir / "d/errors/EA-plus/log.csv", "old");
  spit(dir / "d/errors/EA-plus.toml", "old");
  spit(dir / "d/errors/errors.json", "old");
  spit(dir / "d/log.csv.part-12-3", "old");
  EXPECT_EQ(run(again).code, 0) << slurp(dir / "stderr.txt");
  EXPECT_FALSE(fs::exists(dir / "d/errors"));
  EXPECT_FALSE(fs::exists(dir / "d/log.csv.part-12-3"));
  // `resume` removes parts of its own files alone.
  ASSERT_EQ(run("run s.toml --out h --quiet --until 0.2").code, 0);
  spit(dir / "h/movie.webm.part-2", "mine");
  spit(dir / "h/log.csv.part-12-3", "old");
  ASSERT_EQ(run("resume h --quiet").code, 0) << slurp(dir / "stderr.txt");
  EXPECT_EQ(slurp(dir / "h/movie.webm.part-2"), "mine");
  EXPECT_FALSE(fs::exists(dir / "h/log.csv.part-12-3"));
}

TEST_F(Surroundings, AValidationRemovesTheWorkOfItsCasesAlone) {
  fs::create_directories(dir / "v/work-chain-stretch");
  spit(dir / "v/work-chain-stretch/thesis.txt", "mine");
  const std::string program =
      (fs::path(ROPEWALK_PROGRAM).parent_path().parent_path() / "validate/ropewalk-validate").string();
  if (!fs::exists(program)) GTEST_SKIP() << "ropewalk-validate is not built";
  const std::string list = script("'" + program + "' list").out, name = list.substr(0, list.find(' '));
  fs::rename(dir / "v/work-chain-stretch", dir / ("v/work-" + name));
  script("'" + program + "' run --out v " + name);
  EXPECT_EQ(slurp(dir / ("v/work-" + name) / "thesis.txt"), "mine");
  EXPECT_THAT(slurp(dir / "stdout.txt") + slurp(dir / "stderr.txt") + slurp(dir / ("v/" + name + ".json")),
              HasSubstr("this program did not make it"));
}

// A folder of the user's may hold a report.html of another kind.
TEST_F(Surroundings, ResultsReplaceNoFilesOfTheUser) {
  fs::create_directories(dir / "v");
  for (const auto& [name, verb] :
       {std::pair{"report.html", "validate run euler-buckling --quiet --out v"},
        std::pair{"report.json", "validate run euler-buckling --quiet --out v"},
        std::pair{"report.html", "parametrize 5,5 --quiet --out v"},
        std::pair{"tubes.csv", "parametrize 5,5 --quiet --out v"},
        std::pair{"cnt-5-5-tersoff.html", "parametrize 5,5 --quiet --out v"},
        std::pair{"chart.html", "validate chart --quick --quiet --out v"},
        std::pair{"chart.html", "validate chart --from " ROPEWALK_SOURCE_DIR "/data/chart/points.csv --out v"},
        std::pair{"points.csv", "validate chart --quick --quiet --out v"}}) {
    spit(dir / "v" / name, "mine");
    const Outcome o = soon(verb);
    EXPECT_EQ(o.code, 2) << verb << o.err;
    EXPECT_THAT(o.err, HasSubstr(std::string(name) + ": --out: exists, and this program did not make it")) << verb;
    EXPECT_EQ(slurp(dir / "v" / name), "mine") << verb;
    fs::remove(dir / "v" / name);
  }
  // Nor friction that was measured with other sets.
  for (const char* file : {".toml", "-stiffness.csv", "-contact.csv"})
    fs::copy(std::string(ROPEWALK_SOURCE_DIR "/data/parameters/cnt-5-5-tersoff") + file, dir / "v");
  const std::string friction =
      std::regex_replace(slurp(ROPEWALK_SOURCE_DIR "/data/friction/friction-5-5-5-5-tersoff.toml"),
                         std::regex("(set_[ab]_)hash +=[^\n]*"), "$1hash = \"0123456789abcdef\"");
  spit(dir / "v/friction-5-5-5-5-tersoff.toml", friction);
  script(
      "ropewalk parametrize 5,5 --quiet --budget 0.0001 --out v &\n"
      "for k in $(seq 600); do [ -e v/friction-5-5-5-5-tersoff-error.txt ] && break; sleep 0.1; done\n"
      "kill $!; wait $!");
  EXPECT_TRUE(slurp(dir / "v/friction-5-5-5-5-tersoff.toml") == friction);
  EXPECT_THAT(slurp(dir / "v/friction-5-5-5-5-tersoff-error.txt"), HasSubstr("was measured with other sets"));
}

// A set named "outside/mine" makes a page in the current folder, and none in the folder `outside`.
TEST_F(Surroundings, TheNameOfASetLeadsNowhere) {
  fs::create_directories(dir / "outside");
  spit(dir / "set.toml", std::regex_replace(slurp(ROPEWALK_SOURCE_DIR "/data/parameters/cnt-10-10-paper.toml"),
                                            std::regex("\nname = [^\n]*"), "\nname = \"outside/mine\""));
  const Outcome o = run("calibrate show set.toml");
  EXPECT_EQ(o.code, 0) << o.err;
  EXPECT_TRUE(fs::is_empty(dir / "outside"));
  EXPECT_TRUE(fs::exists(dir / "mine.html"));
}

// A killed process leaves a folder of work with its mark, or hardly made.
TEST_F(Surroundings, AFolderOfWorkThatWasHardlyMadeIsTaken) {
  const std::string work = "v/work-euler-buckling";
  fs::create_directories(dir / work);
  spit(dir / work / ".ropewalk-work.part-12-3", "");
  const Outcome o = run("validate run euler-buckling --quiet --out v");
  EXPECT_EQ(o.code, 0) << o.err << o.out;
  EXPECT_FALSE(fs::exists(dir / work));
}

// A point goes on from its checkpoint without a manifest, and one with a log and no checkpoint is left to its
// owner.
TEST_F(Surroundings, ASweepRemovesNoPointThatItCannotGoOnWith) {
  sweep_file("[vary]\nstart.seed = [1, 2, 3]\n");
  ASSERT_EQ(run("sweep w.toml --quiet -j 1").code, 0) << slurp(dir / "stderr.txt");
  const std::string table = slurp(dir / "w/table.csv"), log = slurp(dir / "w/points/seed-2/log.csv");
  ASSERT_EQ(run("run w/points/seed-2/scene.toml --out half --until 0.2 --quiet").code, 0);
  fs::remove_all(dir / "w/points/seed-2");
  fs::rename(dir / "half", dir / "w/points/seed-2");
  fs::remove(dir / "w/points/seed-2/manifest.json");
  ASSERT_EQ(run("sweep w.toml --quiet -j 1").code, 0) << slurp(dir / "stderr.txt");
  EXPECT_EQ(slurp(dir / "w/points/seed-2/log.csv"), log);
  EXPECT_EQ(slurp(dir / "w/table.csv"), table);
  for (const char* name : {"manifest.json", "checkpoint.bin", "checkpoint-before.bin"})
    fs::remove(dir / "w/points/seed-2" / name);
  const auto before = content(dir / "w/points/seed-2");
  const Outcome o = run("sweep w.toml --quiet -j 1");
  EXPECT_EQ(o.code, 3) << o.err;
  EXPECT_TRUE(content(dir / "w/points/seed-2") == before);
  EXPECT_THAT(slurp(dir / "w/messages/seed-2.txt"), HasSubstr("no checkpoint with which it could go on"));
  // Nor is a file of the user's in a point removed.
  spit(dir / "w/points/seed-1/thesis.txt", "mine");
  spit(dir / "s.toml", scene("duration_ps = 0.5\n"));
  const Outcome force = run("sweep w.toml --quiet -j 1 --force");
  EXPECT_EQ(force.code, 2);
  EXPECT_THAT(force.err, HasSubstr("holds thesis.txt, which is not of a run"));
  EXPECT_EQ(slurp(dir / "w/points/seed-1/thesis.txt"), "mine");
}

// --force waits for no one and takes nothing from a sweep that is at work; two sweeps of one directory tell the
// truth.
TEST_F(Surroundings, SweepsOfOneDirectory) {
  spit(dir / "long.toml", scene("duration_ps = 1e7\nlog_every_ps = 1000\n"));
  sweep_file("[vary]\nstart.seed = [1, 2]\n", "long.toml");
  spit(dir / "short.toml", "format = \"ropewalk-sweep-1\"\nscene = \"s.toml\"\n[vary]\nstart.seed = [1, 2]\n");
  const std::string locks = fmt::format("LD_PRELOAD='{}' ROPEWALK_FAULTS_NO_LOCKS=1", ROPEWALK_FAULTS);
  for (const std::string& before : {std::string(), "export " + locks}) {
    fs::remove_all(dir / "w");
    const Outcome o = script(
        before +
        "\nropewalk sweep w.toml --out w --quiet -j 2 > a.txt 2>&1 &\na=$!\n"
        "for k in $(seq 200); do [ -e w/points/seed-1/limits.json -a -e w/points/seed-2/limits.json ] && break; "
        "sleep 0.05; done\n"
        "ropewalk sweep short.toml --out w --quiet --force; echo forced $?\n"
        "ropewalk sweep w.toml --out w --quiet; echo second $?\n"
        "ls w/points/seed-1/checkpoint.bin\nkill -TERM $a\nwait $a\necho first $?\n"
        "ropewalk sweep short.toml --out w --quiet --force; echo forced later $?\nls w | tr '\\n' ' '");
    EXPECT_THAT(o.out, HasSubstr("forced 2\n")) << o.err;
    EXPECT_THAT(o.err, HasSubstr("ropewalk: w: is in use by ")) << o.err;
    EXPECT_THAT(o.out, HasSubstr("2 points: 2 running")) << o.err;
    EXPECT_THAT(o.err, HasSubstr("run elsewhere: seed-1, by process ")) << o.err;
    EXPECT_THAT(o.out, HasSubstr("second 3\nw/points/seed-1/checkpoint.bin\nfirst 143\n")) << o.err;
    EXPECT_THAT(o.out, HasSubstr("2 points: 2 finished")) << o.err;
    EXPECT_THAT(o.out, HasSubstr("forced later 0\nmessages points scene.toml sweep.toml table.csv")) << o.err;
  }
}

// Both would end with runs that "did not finish".
TEST_F(Surroundings, ErrorsOfOneRunAreMadeOnce) {
  spit(dir / "s.toml", scene("duration_ps = 0.1\n"));
  ASSERT_EQ(run("run s.toml --out r --quiet").code, 0) << slurp(dir / "stderr.txt");
  const Outcome o = script("flock r/lock ropewalk errors r --numerics --quiet; echo beside $?\n"
                           "ropewalk errors r --quiet > /dev/null; echo alone $?\nls r");
  EXPECT_THAT(o.out, HasSubstr("beside 2\nalone 0\n")) << o.err;
  EXPECT_THAT(o.err, HasSubstr("ropewalk: r: is in use by ")) << o.err;
  EXPECT_THAT(o.out, Not(HasSubstr("lock\n"))) << "the lock is taken away at the end";
}

TEST_F(Surroundings, NamesOfPointsFitIntoAFileSystem) {
  std::string values;
  for (const char* key : {"bend_deg", "twist_deg", "kink_curvature_per_nm", "wall_twist", "strain", "press_nm",
                          "speed_nm_per_ps", "pressure_GPa", "energy_drift"})
    values += fmt::format("limits.{} = [0.1234567891, 0.1234567892]\n", key);
  for (const char* key : {"log_every_ps", "checkpoint_every_s"})
    values += fmt::format("run.{} = [0.1234567891, 0.1234567892]\n", key);
  sweep_file("combine = \"zip\"\n[vary]\n" + values);
  const Outcome dry = run("sweep w.toml --dry-run");
  ASSERT_EQ(dry.code, 0) << dry.err;
  ASSERT_EQ(run("sweep w.toml --quiet").code, 0) << slurp(dir / "stderr.txt");
  for (const auto& entry : fs::directory_iterator(dir / "w/points"))
    EXPECT_LE(entry.path().filename().string().size(), 230u);
}

// A scene that can be read and not be built is refused before the first run.
TEST_F(Surroundings, AllPointsCanBeBuiltBeforeTheFirstRuns) {
  sweep_file("[vary]\nrun.time_step_fs = [1, 4000]\n");
  for (const char* words : {"", " --dry-run"}) {
    const Outcome o = run(std::string("sweep w.toml --quiet") + words);
    EXPECT_EQ(o.code, 2) << o.err;
    EXPECT_THAT(o.err, HasSubstr("point time_step_fs-4000: ")) << o.err;
    EXPECT_FALSE(fs::exists(dir / "w"));
  }
}

// A campaign that comes from somebody else.
TEST_F(Surroundings, AHostileCampaignReachesNothingOutside) {
  sweep_file("[vary]\nstart.seed = [1, 2]\n");
  ASSERT_EQ(run("sweep w.toml --quiet --out whole").code, 0) << slurp(dir / "stderr.txt");
  fs::create_directories(dir / "outside");
  fs::copy(dir / "whole/points/seed-1", dir / "outside/run", fs::copy_options::recursive);
  fs::remove(dir / "outside/run/manifest.json");
  spit(dir / "outside/file", "mine");
  const auto before = content(dir / "outside");
  const auto link = [&](const char* name, const char* to) {
    fs::remove_all(dir / "h" / name);
    fs::create_directories((dir / "h" / name).parent_path());
    fs::create_symlink(dir / "outside" / to, dir / "h" / name);
  };
  const Cases tried = cases_of_this_run();
  long number = 0;
  for (const auto& [name, to] :
       {std::pair{"points", ""}, std::pair{"messages", ""}, std::pair{"starts", ""},
        std::pair{"points/seed-1", "run"}, std::pair{"messages/seed-2.txt", "file"}, std::pair{"lock", "file"},
        std::pair{"sweep.toml", "file"}, std::pair{"scene.toml", "file"}, std::pair{"table.csv", "file"}})
    for (const char* verb :
         {"sweep w.toml --quiet --out h", "sweep w.toml --quiet --out h --force", "gather h", "compare h whole"}) {
      if (number++ % tried.step != tried.first) continue;
      fs::remove_all(dir / "h");
      fs::copy(dir / "whole", dir / "h", fs::copy_options::recursive);
      fs::remove_all(dir / "h/points/seed-2");  // there is something to run
      link(name, to);
      const Outcome o = soon(verb);
      EXPECT_NE(o.code, 1000) << name << verb;
      EXPECT_TRUE(content(dir / "outside") == before) << name << ": " << verb << "\n" << o.err;
    }
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk::test
