// Where a key of a scene stands, for refusals that come after reading.
#pragma once

#include <string>

#include "model/error.hpp"

namespace ropewalk {

struct Scene;

// File, line and key. `key`: with its table, as "run.time_step_fs"; `of_list`: in that table of a list, from 0; -1: in
// the first that has it. Where the key is not typed, the line is that of its table; where that is missing too, or the
// scene is in no file, 0.
InputError::Place place_in(const Scene& scene, const std::string& key, int of_list = -1);

}  // namespace ropewalk
