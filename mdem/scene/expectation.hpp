// [[expect]] what a run of the scene should give: the scene carries its own result, and a bug report is a test.
#pragma once

#include <optional>
#include <string>

namespace ropewalk {

struct Expectation {
  std::string column;        // column of the log
  std::optional<double> at;  // ps; none: the last row
  double value = 0;          // expected value in the unit of the column
  double tolerance = 0;      // absolute, likewise
  std::string scene_hash;    // what_is_run_hash() of the scene that it holds for; empty: for this scene, as it is
  bool of_other_scene = false;  // the scene has another hash: it is not judged
};

// The hash of all that a scene asks for, but its name, its expectations, and the frames and checkpoints of its
// run. Comments, the order of keys and the way in which numbers are written do not count.
std::string what_is_run_hash(const std::string& scene_text);

}  // namespace ropewalk
