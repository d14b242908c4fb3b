#include "commands/siblings.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <string>

#include "model/error.hpp"
#include "run/cores.hpp"

namespace ropewalk {
namespace {

namespace fs = std::filesystem;

struct Sibling {
  const char* verb;
  const char* program;  // its name without "ropewalk-"
  bool keeps_verb;      // the verb is one of the program's own
};
constexpr Sibling siblings[] = {
    {"calibrate", "calibrate", false}, {"validate", "validate", false}, {"parametrize", "validate", true}};

}  // namespace

std::string find_program(const std::string& folder, const std::string& name) {
  std::error_code error;
  const fs::path here = fs::read_symlink("/proc/self/exe", error).parent_path();
  for (const fs::path& place : {here / name, here / folder / name, here / ".." / folder / name})
    if (fs::is_regular_file(place, error)) return place.lexically_normal().string();
  return name;
}

std::string this_program() {
  std::error_code error;
  return fs::read_symlink("/proc/self/exe", error).string();
}

void hand_over_to_sibling(char** argv) {
  if (!argv[0] || !argv[1]) return;
  for (const Sibling& sibling : siblings) {
    if (sibling.verb != std::string(argv[1])) continue;
    const std::string program = find_program(sibling.program, std::string("ropewalk-") + sibling.program);
    give_back_cores();
    execvp(program.c_str(), sibling.keeps_verb ? argv : argv + 1);
    throw InputError(
        {"", 0, sibling.verb}, fmt::format("the program {} cannot be started", program),
        "after ./demo: .ci/install && cmake --preset release && cmake --build --preset release; or install "
        "the package ropewalk-calibrate");
  }
}

}  // namespace ropewalk
