// Every stored input of every reader, and a few hundred that are made of it by a fixed seed: what clang's libFuzzer
// does for hours (tests/fuzz/run) in a second or two, with any compiler, and under the sanitizers with `./check
// asan`.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <random>
#include <sstream>

#include "fuzz/targets.hpp"

namespace ropewalk::fuzz {
namespace {

namespace fs = std::filesystem;

// The number of mutants of each input.
int mutants() { return std::getenv("ROPEWALK_ALL_FAULTS") ? 1000 : 100; }

std::vector<std::string> corpus(const std::string& name) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(fs::path(ROPEWALK_SOURCE_DIR "/tests/fuzz/corpus") / name))
    files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  std::vector<std::string> inputs;
  for (const fs::path& file : files) {
    std::stringstream text;
    text << std::ifstream(file, std::ios::binary).rdbuf();
    inputs.push_back(text.str());
  }
  return inputs;
}

class Mutator {
 public:
  explicit Mutator(unsigned seed) : random_(seed) {}

  std::string operator()(std::string text) {
    for (std::size_t k = 1 + below(4); k > 0; --k) change(text);
    return text;
  }

 private:
  std::size_t below(std::size_t n) { return n > 0 ? random_() % n : 0; }

  void change(std::string& text) {
    static const std::vector<std::string> words = {"nan",
                                                   "-nan",
                                                   "inf",
                                                   "1e999",
                                                   "1e300",
                                                   "-1e300",
                                                   "1e-320",
                                                   "-1",
                                                   "0",
                                                   "9223372036854775807",
                                                   "-9223372036854775808",
                                                   "4294967296",
                                                   "2147483647",
                                                   "\"",
                                                   "'",
                                                   "[",
                                                   "]",
                                                   "{",
                                                   "}",
                                                   "=",
                                                   ",",
                                                   ".",
                                                   "#",
                                                   "\n",
                                                   "\t",
                                                   std::string(1, '\0'),
                                                   "\x1b[31m",
                                                   "\xc2\x85",
                                                   "\xff",
                                                   "&\n",
                                                   "$(x)",
                                                   "null",
                                                   "true"};
    const std::size_t at = below(text.size() + 1), length = below(std::min<std::size_t>(text.size() - at, 40) + 1);
    switch (below(6)) {
      case 0:
        if (at < text.size()) text[at] = static_cast<char>(random_());
        break;
      case 1:
        text.erase(at, length);
        break;
      case 2:
        text.insert(at, text.substr(at, length));
        break;
      case 3:
        text.insert(at, words[below(words.size())]);
        break;
      case 4:
        replace_number(text, at, words[below(13)]);
        break;
      default:
        for (std::size_t k = at; k < std::min(at + 8, text.size()); ++k) text[k] = static_cast<char>(random_());
    }
  }

  // The next number after `at`.
  static void replace_number(std::string& text, std::size_t at, const std::string& by) {
    const std::size_t from = text.find_first_of("0123456789", at);
    if (from == std::string::npos) return;
    text.replace(from, text.find_first_not_of("0123456789.e+-", from) - from, by);
  }

  std::mt19937 random_;
};

class Readers : public ::testing::TestWithParam<Target> {};

TEST_P(Readers, TakeOrRefuseWhateverTheyGet) {
  const Target& target = GetParam();
  const std::vector<std::string> inputs = corpus(target.name);
  ASSERT_FALSE(inputs.empty()) << "no corpus for " << target.name;
  Mutator mutate(1);
  std::size_t tried = 0;
  for (const std::string& input : inputs) {
    ASSERT_NO_THROW(target.read(input)) << input;
    for (int k = 0; k < mutants(); ++k) {
      const std::string other = mutate(input);
      ASSERT_NO_THROW(target.read(other)) << other;
    }
    tried += 1 + static_cast<std::size_t>(mutants());
  }
  std::cout << target.name << ": " << tried << " inputs\n";
}

INSTANTIATE_TEST_SUITE_P(Fuzz, Readers, ::testing::ValuesIn(targets()),
                         [](const auto& info) { return std::string(info.param.name); });

}  // namespace

void PrintTo(const Target& target, std::ostream* out) { *out << target.name; }

}  // namespace ropewalk::fuzz
