#include "scene/taken_name.hpp"

#include <cerrno>
#include <cstdio>
#include <cstdlib>

namespace ropewalk {

void refuse_taken_name(bool taken, const char* what, const std::string& name) {
  if (!taken) return;
  std::fprintf(stderr, "%s: a %s of one's own is called \"%s\", and this name is taken; give it another one\n",
               program_invocation_short_name, what, name.c_str());
  std::_Exit(2);
}

}  // namespace ropewalk
