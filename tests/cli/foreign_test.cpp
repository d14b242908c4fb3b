// Nothing foreign gets in: what users name stays a name in every file that another program reads, and no input or
// output without an end or a place takes the program along.
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
using ::testing::Not;
namespace fs = test::fs;

class Foreign : public test::Cli {
 protected:
  void scene(const std::string& file, const std::string& name) const {
    spit(dir / file, fmt::format("format = \"ropewalk-scene-1\"\nname = {}\nparameters = \"cnt-10-10-tersoff\"\n"
                                 "[rope]\ntubes = 7\nlength_nm = 6\n[run]\nduration_ps = 0.5\n",
                                 name));
  }
  Outcome shell(const std::string& command) const {
    const int status = std::system(("cd '" + dir.string() + "' && PATH='" +
                                    fs::path(ROPEWALK_PROGRAM).parent_path().string() + "':$PATH && " + command)
                                       .c_str());
    Outcome o;
    o.code = WIFEXITED(status) ? WEXITSTATUS(status) : 1000;
    return o;
  }
};

// The verse that made LAMMPS run a shell; and a script that made a browser run it.
constexpr const char* name = "'<script>alert(1)</script> & \"\"\" ${x} $(touch pwned) `touch pwned` # ]]> =1+1'";

TEST_F(Foreign, ANameIsOnlyAName) {
  scene("a.toml", name);
  ASSERT_EQ(run("export a.toml --lammps there").code, 0) << slurp(dir / "stderr.txt");
  scene("b.toml", "\"b\"");
  ASSERT_EQ(run("export b.toml --lammps plain").code, 0);
  const auto after_title = [&](const char* file) {
    const std::string text = slurp(dir / file);
    EXPECT_THAT(text.substr(0, text.find('\n')), Not(::testing::ContainsRegex("[$&#\"`<>].*&|\"\"\"|[$`]")));
    return text.substr(text.find('\n'));
  };
  EXPECT_EQ(after_title("there/in.rope"), after_title("plain/in.rope"));
  ASSERT_EQ(run("run a.toml --out d --quiet").code, 0) << slurp(dir / "stderr.txt");
  ASSERT_EQ(run("compare d d --page c.html").code, 0) << slurp(dir / "stderr.txt");
  ASSERT_EQ(run("picture d -o p.svg").code, 0) << slurp(dir / "stderr.txt");
  for (const char* page : {"d/report.html", "c.html", "p.svg"})
    EXPECT_THAT(slurp(dir / page), Not(HasSubstr("<script>alert"))) << page;
  EXPECT_THAT(slurp(dir / "d/report.html"), HasSubstr("&lt;script&gt;alert(1)"));
  EXPECT_EQ(run("resume d --quiet --until 0.6").code, 0) << slurp(dir / "stderr.txt");
}

TEST_F(Foreign, ACampaignQuotesWhatItNames) {
  scene("it's $(touch pwned).toml", "\"x\"");
  spit(dir / "s '`touch pwned`.toml",
       "format = \"ropewalk-sweep-1\"\nscene = \"it's $(touch pwned).toml\"\n[vary]\nname = [\"=1+1\", "
       "\"<script>alert(1)</script>\"]\n");
  const std::string sweep = "\"s '\\`touch pwned\\`.toml\"";
  ASSERT_EQ(run("sweep " + sweep + " --out 'a b' --slurm job.sh").code, 0) << slurp(dir / "stderr.txt");
  EXPECT_EQ(shell("SLURM_ARRAY_TASK_ID=1 sh job.sh > out.txt 2>&1").code, 0) << slurp(dir / "out.txt");
  EXPECT_EQ(run("sweep " + sweep + " --out 'a b' --quiet").code, 0) << slurp(dir / "stderr.txt");
  EXPECT_THAT(slurp(dir / "a b/table.csv"), HasSubstr(",'=1+1,"));
  ASSERT_EQ(run("sweep " + sweep + " --out 'a#%$b' --slurm j.sh").code, 0) << slurp(dir / "stderr.txt");
  EXPECT_EQ(shell("SLURM_ARRAY_TASK_ID=2 sh j.sh").code, 0);
  EXPECT_TRUE(fs::exists(dir / "a#%$b/messages/slurm-2.txt"));
  EXPECT_EQ(run("sweep " + sweep + " --out 'a{b}' --snakemake S").code, 2);
  EXPECT_EQ(run("compare 'a b' --page c.html").code, 0) << slurp(dir / "stderr.txt");
  EXPECT_THAT(slurp(dir / "c.html"), Not(HasSubstr("<script>alert")));
  for (const auto& entry : fs::recursive_directory_iterator(dir))
    EXPECT_NE(entry.path().filename(), "pwned") << entry.path();
}

TEST_F(Foreign, ControlCharactersAreRefusedOnTheCommandLine) {
  for (const char* word : {"$(printf 'a\\nb')", "$(printf 'a\\033[2J')", "$(printf 'a\\302\\205')"}) {
    const Outcome o = run(fmt::format("check \"{}\"", word));
    EXPECT_EQ(o.code, 2) << word;
    EXPECT_THAT(o.err, HasSubstr("holds a control character")) << word;
    EXPECT_EQ(std::count(o.err.begin(), o.err.end(), '\n'), 1) << o.err;
  }
  EXPECT_EQ(run("check \"$(printf '\\377')\"").code, 2);
  EXPECT_EQ(run("run a.toml --out \"$(printf 'd\\n')x\"").code, 2);
}

TEST_F(Foreign, APotentialReachesNoFurtherThanItsLines) {
  const auto refused = [&](const std::string& text, const char* says) {
    spit(dir / "p.txt", text);
    const Outcome o = run("calibrate --chirality 5,5 --quiet --potential-file p.txt");
    EXPECT_EQ(o.code, 2) << text;
    EXPECT_THAT(o.err, HasSubstr(says)) << text;
    EXPECT_EQ(std::count(o.err.begin(), o.err.end(), '\n'), 1) << o.err;
  };
  refused("pair_style tersoff\npair_coeff * * BNC.tersoff C &\n", "p.txt:2: goes on in the next line by &");
  refused("pair_style tersoff & \t\r\npair_coeff * * BNC.tersoff C\n", "p.txt:1: goes on in the next line by &");
  refused("pair_style lj/cut ${x}\npair_coeff * * 1 1\n", "p.txt:1: names a variable, $");
  refused("pair_style lj/cut $(python(x))\npair_coeff * * 1 1\n", "p.txt:1: names a variable, $");
  refused("pair_style tersoff\npair_coeff * * \"\"\"BNC.tersoff C\n", "p.txt:2: holds quotes");
  refused("pair_style tersoff\x01\npair_coeff * * BNC.tersoff C\n", "p.txt:1: holds a control character");
  refused("shell touch pwned\n", "p.txt:1: shell: only pair_style");
  refused("\xef\xbb\xbfpair_style tersoff\n", "p.txt: pair_coeff: is missing");
  EXPECT_FALSE(fs::exists(dir / "pwned"));
}

TEST_F(Foreign, OutputThatCannotBeWrittenIsAnError) {
  scene("a.toml", "\"a\"");
  const std::string programs = fs::path(ROPEWALK_PROGRAM).parent_path().string();
  for (const char* command : {"--help", "--version", "check a.toml", "new --list", "calibrate --help",
                              "calibrate show cnt-10-10-tersoff --table"}) {
    const Outcome o = shell(fmt::format("ropewalk {} > /dev/full 2> err.txt < /dev/null", command));
    EXPECT_EQ(o.code, 2) << command;
    EXPECT_THAT(slurp(dir / "err.txt"), HasSubstr("the standard output cannot be written")) << command;
  }
}

TEST_F(Foreign, WhatHasNoEndIsNotReadToIt) {
  const Outcome o = run("check /dev/zero", "timeout 100");
  EXPECT_EQ(o.code, 2);
  EXPECT_THAT(o.err, HasSubstr("/dev/zero: is not a regular file; name a file"));
  scene("a.toml", "\"a\"");
  EXPECT_EQ(shell("cat a.toml | ropewalk check /dev/stdin > out.txt 2>&1").code, 0) << slurp(dir / "out.txt");
}

// A reader would wait for ever for somebody to write.
TEST_F(Foreign, APipeIsNoFile) {
  ASSERT_EQ(shell("mkfifo pipe pipe.toml pipe.csv").code, 0);
  const auto with = [&](const char* file, const std::string& tables) {
    spit(dir / file, "format = \"ropewalk-scene-1\"\n" + tables + "[run]\nduration_ps = 0.1\n");
  };
  with("state.toml", "parameters = \"cnt-10-10-tersoff\"\n[state]\nfile = \"pipe\"\n");
  with("set.toml", "parameters = \"pipe.toml\"\n[rope]\ntubes = 7\nlength_nm = 6\n");
  with(
      "friction.toml",
      "parameters = \"cnt-10-10-tersoff\"\n[rope]\ntubes = 7\nlength_nm = 6\n[[friction]]\nfrom = \"pipe.toml\"\n");
  spit(dir / "of-pipe.toml", "format = \"ropewalk-sweep-1\"\nscene = \"pipe.toml\"\n[vary]\nrope.tubes = [1]\n");
  for (const char* arguments : {"check pipe",
                                "run pipe --out d",
                                "bench pipe",
                                "sweep pipe --dry-run",
                                "threshold pipe --out t",
                                "sweep of-pipe.toml --dry-run",
                                "check state.toml",
                                "check set.toml",
                                "check friction.toml",
                                "energy pipe --parameters cnt-10-10-tersoff",
                                "energy pipe.csv --parameters pipe.toml",
                                "export pipe --lammps e",
                                "calibrate show pipe.toml",
                                "compare pipe.toml cnt-10-10-tersoff",
                                "rest pipe",
                                "modes pipe",
                                "coarsen pipe -o c",
                                "coarsen pipe.csv --state c.csv",
                                "atoms pipe.csv -o a.xyz --parameters cnt-10-10-tersoff",
                                "calibrate fluctuations pipe"}) {
    const Outcome o = run(arguments, "timeout 60");
    EXPECT_EQ(o.code, 2) << arguments << ": " << o.err;
    EXPECT_EQ(std::count(o.err.begin(), o.err.end(), '\n'), 1) << o.err;
  }
}

// The parser and all that walks through its tables call themselves for each level.
TEST_F(Foreign, DeepAndLongTextsAreRefused) {
  const auto parts = [](int count) {
    std::string key = "a";
    for (int k = 1; k < count; ++k) key += ".a";
    return key;
  };
  const auto nested = [](int count, const char* open, const char* close) {
    std::string text;
    for (int k = 0; k < count; ++k) text += open;
    for (int k = 0; k < count; ++k) text += close;
    return text;
  };
  const struct {
    std::string text;
    const char* words;
  } wrong[] = {{"[" + parts(50000) + "]", "has a key of more than 32 parts"},
               {parts(50000) + " = 1", "has a key of more than 32 parts"},
               {"[[" + parts(33) + "]]", "has a key of more than 32 parts"},
               {"\"a\".'b'." + parts(40) + " = 1", "has a key of more than 32 parts"},
               {"x = " + nested(50000, "[", "]"), "has more than 32 brackets in one another"},
               {"x = " + nested(40, "{a = ", "}"), "has more than 32 brackets in one another"},
               {"x = " + nested(200, ("{" + parts(31) + " = [").c_str(), "]}"), "has more than 32 brackets"}};
  for (const auto& w : wrong) {
    spit(dir / "scene.toml", "format = \"ropewalk-scene-1\"\n" + w.text + "\n");
    spit(dir / "sweep.toml", "format = \"ropewalk-sweep-1\"\n" + w.text + "\n");
    spit(dir / "set.toml", "# a set\n" + w.text + "\n");
    for (const char* arguments : {"check scene.toml", "sweep sweep.toml --dry-run", "calibrate show set.toml"}) {
      const Outcome o = run(arguments, "timeout 60");
      EXPECT_EQ(o.code, 2) << arguments << ": " << o.err.substr(0, 300);
      EXPECT_THAT(o.err, HasSubstr(fmt::format(":2: {}", w.words))) << arguments;
      EXPECT_LT(o.err.size(), 300u);
    }
  }
  // Dots of numbers, texts and comments are no parts of keys.
  std::string numbers = "1.5";
  for (int k = 0; k < 100; ++k) numbers += ", 1.5";
  spit(dir / "ok.toml", "format = \"ropewalk-scene-1\"\nname = \"" + parts(50) + "\" # " + parts(50) +
                            "\nparameters = \"cnt-10-10-tersoff\"\n[rope]\ntubes = 7\nlength_nm = 6\n[run]\nx = [" +
                            numbers + "]\nduration_ps = 0.5\n");
  EXPECT_THAT(run("check ok.toml").err, HasSubstr("ok.toml:8: run.x: unknown key"));
}

TEST_F(Foreign, ThreadsOfTheEnvironmentHaveABound) {
  scene("a.toml", "\"a\"");
  for (const char* program : {"check a.toml", "run a.toml --out d --quiet", "calibrate show cnt-10-10-tersoff"}) {
    const Outcome o = run(program, "OMP_NUM_THREADS=100000");
    EXPECT_EQ(o.code, 2) << program << o.err;
    EXPECT_THAT(o.err, HasSubstr("OMP_NUM_THREADS: asks for 100000 threads; set it to 1 to 1024")) << program;
    EXPECT_EQ(std::count(o.err.begin(), o.err.end(), '\n'), 1) << o.err;
  }
}

// What `run` carries through by shorter steps, the verbs that try some steps carry through too.
TEST_F(Foreign, WhatRunsIsNotRefused) {
  for (const int drag : {0, 350, 3500}) {
    spit(dir / "b.toml",
         fmt::format("format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-tersoff\"\n[rope]\ntubes = 7\n"
                     "length_nm = 7\n[twist]\nmoment_nN_nm = 5\nrate_nN_nm_per_ps = 5\n[[friction]]\n"
                     "strength_pN_per_nm = 10\ndrag_eV_ps_per_nm3 = {}\n[run]\nduration_ps = 0.2\n",
                     drag));
    spit(dir / "w.toml", "format = \"ropewalk-sweep-1\"\nscene = \"b.toml\"\n[vary]\nrope.tubes = [7]\n");
    for (const char* arguments : {"run b.toml --out r --quiet --force", "check b.toml", "bench b.toml --steps 20",
                                  "sweep w.toml --dry-run"}) {
      const Outcome o = run(arguments);
      EXPECT_EQ(o.code, 0) << drag << ": " << arguments << ": " << o.err;
      EXPECT_EQ(o.out.find("nan"), std::string::npos) << o.out;
    }
  }
}

TEST_F(Foreign, TooManyOpenFilesAreSaidToBeSo) {
  scene("a.toml", "\"a\"");
  const Outcome r = run("run a.toml --out d --quiet", "sh -c 'ulimit -n 5; exec \"$0\" \"$@\"'");
  EXPECT_NE(r.code, 0);
  EXPECT_THAT(r.err, HasSubstr("Too many open files")) << r.err;
  EXPECT_THAT(r.err, HasSubstr("ulimit -n")) << r.err;
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
