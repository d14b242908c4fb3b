// Texts of users that another program interprets, and the last message of a program.
#include "io/plain_text.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cstdlib>
#include <filesystem>
#include <new>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "campaign/campaign.hpp"
#include "io/csv_reader.hpp"
#include "io/error_exit.hpp"
#include "model/error.hpp"
#include "scene/memory_size.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

TEST(PlainText, ControlCharactersAreThoseOfUnicode) {
  for (int c = 0; c < 0x20; ++c) EXPECT_TRUE(has_control_character(std::string("a") + static_cast<char>(c))) << c;
  for (int c = 0x80; c < 0xa0; ++c)
    EXPECT_TRUE(has_control_character(std::string("a\xc2") + static_cast<char>(c))) << c;
  EXPECT_TRUE(has_control_character("\x7f"));
  for (const char* fine : {"", "a rope", "n\xc3\xa4he", "\xe2\x82\xac", "\xc2\xa0", "$&\"'#\\"})
    EXPECT_FALSE(has_control_character(fine)) << fine;
  EXPECT_EQ(printable("a\n\x1b[2J\x7f\xc2\x85z"), "a\\n\\x1b[2J\\x7f\\x85z");
}

TEST(PlainText, KnowsUtf8) {
  for (const char* fine : {"", "a", "\xc3\xa4", "\xe2\x82\xac", "\xf0\x9f\x98\x80"}) EXPECT_TRUE(is_utf8(fine));
  for (const char* wrong : {"\xff", "\xc3", "\xe2\x82", "\x80", "\xc0\x80", "\xed\xa0\x80", "\xf4\x90\x80\x80"})
    EXPECT_FALSE(is_utf8(wrong));
}

// The shell itself says what it reads.
TEST(PlainText, AShellReadsOneWord) {
  for (const std::string text :
       {"a b", "$(touch pwned)", "`x`", "it's", "'; touch pwned; '", "\\", "*", "\"", "#"}) {
    const std::string command = "printf %s " + shell_quoted(text);
    std::FILE* pipe = popen(command.c_str(), "r");
    char read[100] = {};
    ASSERT_TRUE(pipe);
    const std::size_t n = fread(read, 1, sizeof read, pipe);
    EXPECT_EQ(pclose(pipe), 0);
    EXPECT_EQ(std::string(read, n), text);
  }
}

TEST(PlainText, LammpsReadsANameOrNothing) {
  EXPECT_EQ(lammps_quoted("/usr/share/C.lcbop"), "/usr/share/C.lcbop");
  EXPECT_EQ(lammps_quoted("a b"), "\"a b\"");
  EXPECT_EQ(lammps_quoted("${x}#&"), "\"${x}#&\"");
  EXPECT_EQ(lammps_quoted("a\"b"), "'a\"b'");
  EXPECT_THROW(lammps_quoted("a\"b'c"), InputError);
  EXPECT_THROW(lammps_quoted("a\nshell touch pwned"), InputError);
  EXPECT_EQ(lammps_comment("a & \"\"\" $(1/0) # `x` ; \\"), "a _ ___ _(1/0) _ _x_ ; _");
  EXPECT_LE(lammps_comment(std::string(1000, 'x')).size(), 80u);
}

TEST(PlainText, ANumberIsReadUpToItsEnd) {
  std::size_t length = 0;
  EXPECT_EQ(leading_number(" 1.5 eV", &length), 1.5);
  EXPECT_EQ(length, 4u);
  EXPECT_EQ(leading_number("-2e-3%", &length), -2e-3);
  EXPECT_EQ(length, 5u);
  EXPECT_EQ(leading_number("1,5"), 1);
  for (const char* none : {"", " ", "x1", ",5"}) EXPECT_FALSE(leading_number(none)) << none;
}

TEST(PlainText, ACellIsNoFormula) {
  for (const char* same : {"a", "-1.5", "+2", "1e-3", "rope 7"})
    EXPECT_EQ(csv_cell(same), same[0] == '+' ? "'+2" : same);
  EXPECT_EQ(csv_cell("=1+1"), "'=1+1");
  EXPECT_EQ(csv_cell("@x"), "'@x");
  EXPECT_EQ(csv_cell("-x"), "'-x");
  EXPECT_EQ(csv_cell("=HYPERLINK(\"x\",\"y\")"), "\"'=HYPERLINK(\"\"x\"\",\"\"y\"\")\"");
  EXPECT_EQ(csv_cell("a,b"), "\"a,b\"");
}

TEST(Cluster, FilesHoldNamesAsData) {
  const std::string odd = "it's $(touch pwned) `x` \"y\"";
  const SweepPoint point{"tubes-7", {}, "", "", {}, {}, "", 1};
  const std::string program = "/a b/ropewalk";
  const std::string slurm = slurm_script(program, "sweep", "/" + odd, {"/c d"}, 1000, " --again");
  EXPECT_NE(slurm.find("#SBATCH --array=1-1000\n"), std::string::npos) << slurm;
  EXPECT_NE(slurm.find("exec '/a b/ropewalk' sweep " + shell_quoted("/" + odd) +
                       " --out '/c d' --only \"$SLURM_ARRAY_TASK_ID\" --jobs"),
            std::string::npos)
      << slurm;
  EXPECT_NE(slurm.find(" --quiet --again\n"), std::string::npos) << slurm;
  const std::string many = slurm_script(program, "sweep", "s.toml", {"d"}, 2001, "");
  EXPECT_NE(many.find("#SBATCH --array=1-667\n"), std::string::npos) << "three points a task: " << many;
  EXPECT_NE(many.find("--only \"$(seq -s , \"$SLURM_ARRAY_TASK_ID\" 667 2001)\""), std::string::npos) << many;
  const std::string snakemake = snakemake_file(program, "sweep", odd, {"a\"b"}, {point}, "");
  EXPECT_NE(snakemake.find("    \"tubes-7\",\n"), std::string::npos) << snakemake;
  EXPECT_NE(snakemake.find("input: \"it's $(touch pwned) `x` \\\"y\\\"\"\n"), std::string::npos) << snakemake;
  EXPECT_NE(snakemake.find("expand(\"a\\\"b/points/{point}/report.html\", point=POINTS)"), std::string::npos);
  EXPECT_THROW(snakemake_file(program, "sweep", "s{x}.toml", {"a"}, {point}, ""), InputError);
  EXPECT_THROW(snakemake_file(program, "sweep", "s.toml", {"a}"}, {point}, ""), InputError);
}

TEST(Failure, IsALineWithARemedy) {
  EXPECT_NE(error_words(std::bad_alloc()).find("the memory does not suffice; take fewer"), std::string::npos);
  EXPECT_NE(error_words(std::length_error("cannot create std::vector")).find("memory"), std::string::npos);
  try {
    [[maybe_unused]] const auto json = nlohmann::json::parse("{");
  } catch (const std::exception& e) {
    EXPECT_EQ(error_words(e).find("a JSON file does not hold what it should; restore it"), 0u)
        << error_words(e);
    EXPECT_EQ(error_code(e), 2);
  }
  try {
    std::filesystem::create_directory("/proc/none/x");
  } catch (const std::exception& e) {
    EXPECT_EQ(error_words(e).find("/proc/none/x: cannot be used: "), 0u) << error_words(e);
    EXPECT_EQ(error_code(e), 2);
  }
  EXPECT_EQ(error_code(std::bad_alloc()), 3);
  EXPECT_EQ(error_words(InputError({"a\nb", 1, "k"}, "x", "y")), "a\\nb:1: k: x; y");
}

TEST(PlainText, LongLinesGoOnBelowTheirOwnColumn) {
  const std::string words(59, 'a'), line = "  --option TEXT    " + words + " " + words;
  EXPECT_EQ(within_width(line), "  --option TEXT    " + words + "\n" + std::string(19, ' ') + words);
  EXPECT_EQ(within_width("short\n"), "short\n");
  EXPECT_EQ(within_width(std::string(130, 'x')), std::string(130, 'x')) << "nowhere to break";
  std::string accents;
  for (int k = 0; k < 60; ++k) accents += "é";
  EXPECT_EQ(within_width(accents + " " + std::string(59, 'x')), accents + " " + std::string(59, 'x'));
  EXPECT_EQ(markdown_within_width("- " + words + "\n  " + words + "\n  b\n\n```\nx\ny\n```\nc\nd\n"),
            "- " + words + "\n  " + words + " b\n\n```\nx\ny\n```\nc d\n");
}

TEST(Memory, IsThatOfTheLimit) {
  EXPECT_EQ(beyond_memory(1000), "");
  EXPECT_NE(beyond_memory(1e12), "");
  struct rlimit before {};
  ASSERT_EQ(getrlimit(RLIMIT_DATA, &before), 0);
  struct rlimit less = before;
  less.rlim_cur = 1000000000;
  ASSERT_EQ(setrlimit(RLIMIT_DATA, &less), 0);
  const double allowed = memory_allowed();
  const std::string words = beyond_memory(1e6);
  setrlimit(RLIMIT_DATA, &before);
  EXPECT_LE(allowed, 1e9);
  EXPECT_EQ(words.find("about 2.5 GB of memory, and "), 0u) << words;
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
