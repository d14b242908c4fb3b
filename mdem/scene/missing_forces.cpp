#include "scene/missing_forces.hpp"

#include <fmt/format.h>

#include "model/error.hpp"

namespace ropewalk {

void refuse_missing_forces(const std::string& forces, const std::string& path) {
  if (forces.empty()) return;
  throw InputError({path, 0, ""},
                   fmt::format("the run had forces of one's own, in Python: {}; no file holds them, and without "
                               "them this would be another rope",
                               forces),
                   "go on in Python, where they are: ropewalk.resume(DIR, forces=[...]) or Run.simulation(forces=[...])");
}

}  // namespace ropewalk
