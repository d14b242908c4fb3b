// A run whose elements are split on its way goes on in a directory of its own beside the first: RUN, RUN.fine,
// RUN.fine2, ... Each is a run like any other, to be observed, reported and resumed; limits.json names the others.
#pragma once

#include <string>

#include "run/run_directory.hpp"

namespace ropewalk {

// Of the next stage.
RunDirectory finer_directory(const RunDirectory& dir);

// Name of a directory without the path to it.
std::string name_of(const RunDirectory& dir);

// Makes it, with the finer scene, parameter sets and, for [state], the halved state of time zero; with `force`
// in the place of an earlier run. `time`: of the splitting, ps.
RunDirectory write_finer_scene(const RunDirectory& from, const Scene& scene, const Prepared& prepared, double time,
                               bool force);

}  // namespace ropewalk
