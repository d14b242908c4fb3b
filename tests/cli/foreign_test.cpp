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
  EXPECT_THAT(o.err, HasSubstr("/dev/zero: is no file, and has not ended after 256 MiB; name a file"));
  scene("a.toml", "\"a\"");
  EXPECT_EQ(shell("cat a.toml | ropewalk check /dev/stdin > out.txt 2>&1").code, 0) << slurp(dir / "out.txt");
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
