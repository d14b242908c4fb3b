// A run once more, with other texts of its inputs, in a directory below `errors` of the first.
#pragma once

#include <string>
#include <vector>

#include "run/run_directory.hpp"

namespace ropewalk {

struct RunInputs {
  std::string scene;
  std::vector<std::string> sets, files;  // their texts: sets of the tube types, files of the drives
  double until_ps = -1;                  // time at which it stops; -1: the scene's end
};
// Those that a run was made with, which has ended.
RunInputs inputs_of(const RunDirectory& run, const Scene& scene, const Prepared& prepared);

// The scene with its time step typed, and without frames between the first and the last.
std::string repeatable_scene(const std::string& text, const Scene& scene, const Prepared& prepared);

// The scene of these inputs, read from a folder, where the run `base` has its state file.
Scene scene_of(const RunInputs& inputs, const RunDirectory& base, const Scene& scene, const std::string& folder);

// Runs them in the directory errors/NAME of `base`. A run of the same inputs that was begun goes on, one that is
// finished stays, unless `again` is set; one of other inputs or with another end is replaced. Returns its exit code;
// that it was not as its scene expects is no failure.
int repeat_run(const RunDirectory& base, const Scene& scene, const std::string& name, const RunInputs& inputs,
               bool again);

}  // namespace ropewalk
