// law = "line".
#pragma once

#include <vector>

#include "model/contact/line.hpp"

namespace ropewalk {

struct Scene;

// The `line` law between all pairs of the scene's tube types, i, j at i * types + j.
std::vector<LineContact> line_contacts(const Scene& scene);

}  // namespace ropewalk
