// LAMMPS as a child process: its messages, and every way in which it can end.
#include "atoms/lammps.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>

#include "atoms/potential.hpp"
#include "signals.hpp"

namespace ropewalk::calibrate {
namespace {
namespace UNIT {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

class Environment {
 public:
  Environment(const char* name, const std::string& value) : name_(name) {
    if (const char* old = std::getenv(name)) old_ = old, had_ = true;
    ::setenv(name, value.c_str(), 1);
  }
  ~Environment() { had_ ? ::setenv(name_, old_.c_str(), 1) : ::unsetenv(name_); }

 private:
  const char* name_;
  std::string old_;
  bool had_ = false;
};

class Lammps : public testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (fs::temp_directory_path() / "ropewalk-test-XXXXXX").string();
    ASSERT_NE(::mkdtemp(pattern.data()), nullptr);
    folder = pattern;
    ::unsetenv("ROPEWALK_LMP");
  }
  void TearDown() override {
    std::error_code ignored;
    fs::remove_all(folder, ignored);
  }

  std::string script(const std::string& body) {
    const std::string path = folder + "/fake-lmp";
    std::ofstream(path) << "#!/bin/sh\n" << body << "\n";
    ::chmod(path.c_str(), 0755);
    return path;
  }
  std::string text_of(const std::string& name) {
    std::ifstream file(folder + "/" + name);
    std::stringstream text;
    text << file.rdbuf();
    return text.str();
  }
  template <class Error>
  std::string message(const std::string& input, const LammpsOptions& options = {}) {
    try {
      run_lammps(folder, "case", input, options);
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), Not(HasSubstr("\n"))) << "one line only";
      return error.what();
    } catch (const std::exception& error) {
      ADD_FAILURE() << "another error: " << error.what();
      return "";
    }
    ADD_FAILURE() << "no error";
    return "";
  }
  // An orphan may stay as a zombie where nobody reaps: that one has ended.
  static bool runs(pid_t pid) {
    std::ifstream file("/proc/" + std::to_string(pid) + "/stat");
    std::string line;
    if (!std::getline(file, line)) return false;
    const auto state = line.rfind(')');
    return state != std::string::npos && state + 2 < line.size() && line[state + 2] != 'Z';
  }
  static void wait_until_gone(pid_t pid) {
    for (int i = 0; i < 100 && runs(pid); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }

  std::string folder;
};

TEST_F(Lammps, TellsItsVersionPackagesAndStyles) {
  const LammpsVersion version = lammps_version({});
  EXPECT_THAT(version.text, HasSubstr("20"));
  EXPECT_THAT(version.text, Not(HasSubstr("\n")));
  EXPECT_THAT(version.packages, testing::Contains("MANYBODY"));
  for (const char* style : {"tersoff", "airebo", "rebo", "lcbop", "lj/cut"})
    EXPECT_TRUE(version.has_pair_style(style));
  EXPECT_FALSE(version.has_pair_style("harmonic")) << "a bond style, after the pair styles";
}

TEST_F(Lammps, AbsentProgramNamesThePackageToInstall) {
  const std::string absent = folder + "/lmp";
  const Environment other("ROPEWALK_LMP", absent);
  try {
    lammps_version({});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr(absent));
    EXPECT_THAT(error.what(), HasSubstr("apt-get install lammps lammps-data"));
  }
  EXPECT_THAT(message<InputError>("units metal\n"), HasSubstr("apt-get install"));
}

TEST_F(Lammps, ProgramThatIsNotLammpsIsFoundOut) {
  LammpsOptions options;
  options.program = "/bin/true";
  EXPECT_THROW(lammps_version(options), InputError);
}

TEST_F(Lammps, KeepsInputLogAndOutput) {
  run_lammps(folder, "case", "units metal\nprint \"well done\"\n", {});
  EXPECT_THAT(text_of("case.in"), HasSubstr("units metal"));
  EXPECT_THAT(text_of("case.log"), HasSubstr("well done"));
  EXPECT_THAT(text_of("case.out"), HasSubstr("well done"));
}

TEST_F(Lammps, RunsOnOneThreadInItsFolder) {
  LammpsOptions options;
  options.program = script("echo threads $OMP_NUM_THREADS in $(pwd); echo 'Total wall time' > case.log");
  run_lammps(folder, "case", "units metal\n", options);
  EXPECT_THAT(text_of("case.out"), HasSubstr("threads 1 in " + fs::canonical(folder).string()));
}

TEST_F(Lammps, ErrorLineAndLastCommandAreQuoted) {
  const std::string text = message<LammpsError>("units metal\natom_style atomic\nfrobnicate 3 4\n");
  EXPECT_THAT(text, HasSubstr("ERROR: Unknown command: frobnicate 3 4"));
  EXPECT_THAT(text, HasSubstr("last command was 'frobnicate 3 4'"));
  EXPECT_THAT(text, HasSubstr(folder));
}

TEST_F(Lammps, LostAtomIsTold) {
  const std::string text = message<LammpsError>(
      "units metal\natom_style atomic\nboundary f f f\nregion box block 0 10 0 10 0 10\ncreate_box 1 box\n"
      "create_atoms 1 single 5 5 5\ncreate_atoms 1 single 5 5 9.9\nmass 1 12\npair_style lj/cut 3\n"
      "pair_coeff 1 1 0.01 1\nvelocity all set 0 0 1000\nfix 1 all nve\nrun 100\n");
  EXPECT_THAT(text, HasSubstr("Lost atoms"));
  EXPECT_THAT(text, HasSubstr("'run 100'"));
  EXPECT_THAT(text, HasSubstr("left the box"));
}

TEST_F(Lammps, MissingPotentialFileIsTold) {
  const std::string text = message<LammpsError>(
      "units metal\natom_style atomic\nregion box block 0 10 0 10 0 10\ncreate_box 1 box\nmass 1 12\n"
      "pair_style tersoff\npair_coeff * * " +
      folder + "/no.tersoff C\n");
  EXPECT_THAT(text, HasSubstr("no.tersoff"));
  EXPECT_THAT(text, HasSubstr("lammps-data"));
}

TEST_F(Lammps, SilentChildIsEndedWithAllItStarted) {
  LammpsOptions options;
  options.program = script("sleep 1000 &\necho $! > sleeper; wait");
  options.quiet_seconds = 0.4;
  const auto start = std::chrono::steady_clock::now();
  EXPECT_THAT(message<LammpsError>("units metal\n", options), HasSubstr("wrote nothing for 0.4 s"));
  EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), 5);
  const pid_t sleeper = std::stoi(text_of("sleeper"));
  wait_until_gone(sleeper);
  EXPECT_FALSE(runs(sleeper));
}

TEST_F(Lammps, ChildThatWritesButNeverEndsIsEnded) {
  LammpsOptions options;
  options.program = script("while true; do echo alive; sleep 0.05; done");
  options.quiet_seconds = 0.5;
  options.max_seconds = 1.2;
  EXPECT_THAT(message<LammpsError>("units metal\n", options), HasSubstr("longer than 1.2 s"));
}

TEST_F(Lammps, ChildThatFloodsIsEnded) {
  LammpsOptions options;
  options.most_bytes = 1 << 20;
  for (const char* flood : {"exec yes", "yes", "yes > case.log", "exec yes > a-file-that-nobody-watches"}) {
    options.program = script(flood);
    EXPECT_THAT(message<LammpsError>("units metal\n", options), HasSubstr("wrote more than 1 MiB and was ended"))
        << flood;
    for (const auto& file : fs::directory_iterator(folder)) EXPECT_LE(fs::file_size(file), 1u << 20) << file;
  }
}

TEST_F(Lammps, SignalIsNamed) {
  LammpsOptions options;
  options.program = script("kill -SEGV $$");
  EXPECT_THAT(message<LammpsError>("units metal\n", options), HasSubstr("ended by SIGSEGV"));
}

TEST_F(Lammps, CallerMayInterrupt) {
  LammpsOptions options;
  options.program = script("sleep 1000");
  const auto start = std::chrono::steady_clock::now();
  options.interrupted = [&] { return std::chrono::steady_clock::now() - start > std::chrono::milliseconds(200); };
  EXPECT_THAT(message<LammpsError>("units metal\n", options), HasSubstr("interrupted"));
}

TEST_F(Lammps, LimitOnFileSizeIsTold) {
  struct rlimit old {};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &old), 0);
  struct rlimit small = old;
  small.rlim_cur = 8 << 20;  // less, and MPI itself does not start
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  const std::string text = message<LammpsError>(
      "variable i loop 2000000\nlabel again\nprint \"a line to fill the disk with, number $i\"\nnext i\n"
      "jump SELF again\n");
  ::setrlimit(RLIMIT_FSIZE, &old);
  EXPECT_THAT(text, HasSubstr("SIGXFSZ"));
  EXPECT_THAT(text, HasSubstr("ulimit -f"));
}

TEST_F(Lammps, LogThatStopsShortIsTold) {
  LammpsOptions options;
  options.program = script("echo LAMMPS > case.log");  // status 0, as LAMMPS does on a full disk
  EXPECT_THAT(message<LammpsError>("units metal\n", options), HasSubstr("incomplete log"));
}

TEST_F(Lammps, FolderThatCannotBeMadeIsAnInputError) {
  std::ofstream(folder + "/file") << "x";
  EXPECT_THROW(run_lammps(folder + "/file/inside", "case", "units metal\n", {}), InputError);
}

// A process that is told to end takes its LAMMPS with it, and dies as it would have.
TEST_F(Lammps, ChildEndsWithItsParent) {
  const test::SignalsOfATerminal signals;
  for (const int number : {SIGTERM, SIGINT, SIGKILL}) {
    LammpsOptions options;
    options.program = script("echo $$ > pid-part; mv pid-part pid; exec sleep 1000");
    fs::remove(folder + "/pid");
    const pid_t parent = ::fork();
    if (parent == 0) {
      try {
        run_lammps(folder, "case", "units metal\n", options);
      } catch (...) {
      }
      ::_exit(0);
    }
    for (int i = 0; i < 250 && !fs::exists(folder + "/pid"); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    ASSERT_TRUE(fs::exists(folder + "/pid"));
    const pid_t child = std::stoi(text_of("pid"));
    EXPECT_TRUE(runs(child));
    ::kill(parent, number);
    int status = 0;
    ::waitpid(parent, &status, 0);
    EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == number);
    wait_until_gone(child);
    EXPECT_FALSE(runs(child)) << "after signal " << number;
  }
}

TEST_F(Lammps, KnownPotentialsAreFoundWithTheirHash) {
  for (const char* name : {"tersoff", "airebo", "rebo", "lcbop"}) {
    const Potential potential = find_potential(name);
    EXPECT_EQ(potential.name, name);
    EXPECT_TRUE(fs::exists(potential.file));
    EXPECT_EQ(potential.file_hash.size(), 16u);
    EXPECT_EQ(potential.commands.size(), 2u);
    EXPECT_GT(potential.cutoff, 0.15);
    EXPECT_FALSE(potential.doi.empty());
  }
  EXPECT_EQ(find_potential("airebo").commands[0], "pair_style airebo 3.0 0 0") << "no Lennard-Jones, no torsion";
}

TEST_F(Lammps, UnknownPotentialGetsASuggestion) {
  try {
    find_potential("tersof");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("did you mean 'tersoff'?"));
  }
}

TEST_F(Lammps, PotentialsFolderOfTheUserIsTheOnlyOne) {
  const Environment elsewhere("LAMMPS_POTENTIALS", folder);
  try {
    find_potential("lcbop");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr(folder));
    EXPECT_THAT(error.what(), HasSubstr("lammps-data"));
  }
  std::ofstream(folder + "/C.lcbop") << "mine";
  EXPECT_EQ(find_potential("lcbop").file, folder + "/C.lcbop");
}

TEST_F(Lammps, UserPotentialHasPairLinesOnly) {
  const auto with = [&](const std::string& content) {
    std::ofstream(folder + "/mine") << content;
    return folder + "/mine";
  };
  std::ofstream(folder + "/my.tersoff") << "x";
  const Potential mine =
      user_potential(with("# mine\npair_style tersoff # at last\n\npair_coeff * * my.tersoff C\n"));
  EXPECT_EQ(mine.name, "user");
  EXPECT_EQ(mine.pair_style, "tersoff");
  ASSERT_EQ(mine.commands.size(), 2u);
  EXPECT_EQ(mine.commands[1], "pair_coeff * * " + folder + "/my.tersoff C") << "from the user's folder";
  const auto error_of = [&](const std::string& content) -> std::string {
    try {
      user_potential(with(content));
    } catch (const InputError& error) {
      return error.what();
    }
    return "none";
  };
  EXPECT_THAT(error_of("pair_style tersoff\nunits real\npair_coeff * * x\n"), HasSubstr("mine:2: units"));
  EXPECT_THAT(error_of("pair_coeff * * x\n"), HasSubstr("pair_style: is missing"));
  EXPECT_THAT(error_of("pair_style tersoff\n"), HasSubstr("pair_coeff: is missing"));
  EXPECT_THAT(error_of("pair_style\n"), HasSubstr("mine:1"));
  // LAMMPS would divide energies of such a file by 23, and the tube be so much too soft.
  std::ofstream(folder + "/my.tersoff") << "# DATE: 2013-03-21 UNITS: real CONTRIBUTOR: me\nC C C 3\n";
  EXPECT_THAT(error_of("pair_style tersoff\npair_coeff * * my.tersoff C\n"),
              HasSubstr("my.tersoff:1: UNITS: is \"real\"; energies are taken in eV"));
  EXPECT_THAT(error_of("# UNITS: real\npair_style tersoff\npair_coeff * * x C\n"), HasSubstr("mine:1: UNITS"));
  const Environment elsewhere("LAMMPS_POTENTIALS", folder);
  std::ofstream(folder + "/C.lcbop") << "# UNITS: real";
  EXPECT_THROW(find_potential("lcbop"), InputError);
  EXPECT_THROW(user_potential(folder + "/none"), InputError);
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk::calibrate
