// A program run as a user runs it, in a directory of its own.
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <regex>
#include <string>
#include <vector>

namespace ropewalk::test {

namespace fs = std::filesystem;

inline std::string slurp(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

inline void spit(const fs::path& path, const std::string& text) { std::ofstream(path, std::ios::binary) << text; }

// Of an exhaustive test, the cases first, first + step, ... from 0 on: a fifth of them where the environment has
// ROPEWALK_FIFTH, 1 to 5, as `./check` sets it, all of them in `./check long`.
struct Cases {
  long first = 0, step = 1;
};
inline Cases cases_of_this_run() {
  const char* fifth = std::getenv("ROPEWALK_FIFTH");
  return fifth ? Cases{std::stol(fifth) - 1, 5} : Cases{};
}

struct Outcome {
  int code = -1;
  std::string out, err;
};

class Cli : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
    dir = fs::temp_directory_path() / ("ropewalk-" + std::string(info->name()) + "-" + std::to_string(getpid()));
    fs::create_directories(dir);
  }
  void TearDown() override { fs::remove_all(dir); }

  // `before`: variables of the environment.
  Outcome run(const std::string& arguments, const std::string& before = "") const {
    const std::string command = "cd '" + dir.string() + "' && " + before + " '" ROPEWALK_PROGRAM "' " + arguments +
                                " > stdout.txt 2> stderr.txt < /dev/null";
    const int status = std::system(command.c_str());
    Outcome o;
    o.code = WIFEXITED(status) ? WEXITSTATUS(status) : 1000;
    o.out = slurp(dir / "stdout.txt");
    o.err = slurp(dir / "stderr.txt");
    return o;
  }

  // The sets that --instructions takes on this machine, widest first.
  std::vector<std::string> instruction_sets_of_help() const {
    const std::string help = run("run --help").out;
    const std::string all = std::regex_replace(help, std::regex("[^]*other\\s+processors:([^\\[]*)\\[[^]*"), "$1");
    std::vector<std::string> sets;
    const std::regex name("\\w+");
    for (std::sregex_iterator at(all.begin(), all.end(), name), end; at != end; ++at) sets.push_back(at->str());
    return sets;
  }

  fs::path dir;
};

}  // namespace ropewalk::test
