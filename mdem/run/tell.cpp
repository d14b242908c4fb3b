#include "run/tell.hpp"

#include <unistd.h>

#include <cstdio>

namespace ropewalk {
namespace {

void put(std::FILE* to, const std::string& text) {
  if (std::fwrite(text.data(), 1, text.size(), to) != text.size()) return;
}

}  // namespace

void tell_as_is(const std::string& text) { put(stderr, text); }

void tell(const std::string& line) {
  tell_as_is((isatty(STDERR_FILENO) ? "\r\033[Kropewalk: " : "ropewalk: ") + line + "\n");
}

void print(const std::string& text) { put(stdout, text); }

}  // namespace ropewalk
