#include "scene/own_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>

#include "io/plain_text.hpp"
#include "model/error.hpp"

namespace ropewalk {
namespace {

std::vector<std::string>& registered() {
  static std::vector<std::string> parts;  // "load wind"
  return parts;
}

bool is_registered(const std::string& part) {
  return std::find(registered().begin(), registered().end(), part) != registered().end();
}

}  // namespace

void refuse_taken_name(bool taken, const char* what, const std::string& name) {
  if (!taken) return;
  std::fprintf(stderr, "%s: a %s of one's own is called \"%s\", and this name is taken; give it another one\n",
               program_invocation_short_name, what, name.c_str());
  std::_Exit(2);
}

void register_own_part(bool taken, const char* what, const std::string& name) {
  refuse_taken_name(taken, what, name);
  registered().push_back(what + (" " + name));
}

bool is_own_part(const std::string& what, const std::string& name) { return is_registered(what + " " + name); }

std::string own_program() { return program_invocation_short_name; }

void refuse_missing_parts(const std::string& parts, const std::string& program, const std::string& path) {
  for (std::size_t begin = 0; begin < parts.size();) {
    const std::size_t end = std::min(parts.find(", ", begin), parts.size());
    const std::string part = parts.substr(begin, end - begin);
    if (!is_registered(part))
      throw InputError({path, 0, ""},
                       fmt::format("was run by {}, a program with parts of its own, and {} lacks its {}",
                                   printable(program, 40), own_program(), printable(part, 60)),
                       fmt::format("read it with that program: {} report {}", printable(program, 40), path));
    begin = end + 2;
  }
}

}  // namespace ropewalk
