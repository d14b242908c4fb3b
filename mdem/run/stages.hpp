// A run whose elements are split goes on in another directory beside the first: RUN, RUN.fine, RUN.fine2, ... Each
// is a complete run, to be observed, reported and resumed; limits.json names the others.
#pragma once

#include <string>

#include "run/run_directory.hpp"

namespace ropewalk {

// The directory of the next stage.
RunDirectory finer_directory(const RunDirectory& dir);

// Name of a directory without its path.
std::string name_of(const RunDirectory& dir);
// The end of its name that says how often the elements were split: "", ".fine", ".fine2". It stays when the
// directory moves.
std::string stage_of(const RunDirectory& dir);

// Makes the directory of the next stage with the finer scene, the parameter sets and, for [state], the halved state
// of time zero. `force` replaces an earlier run there; one that was killed before its first checkpoint is replaced
// anyway. `time` is the time of the splitting, ps. Returns the lock on that directory.
DirectoryLock write_finer_scene(const RunDirectory& from, const Scene& scene, const Prepared& prepared, double time,
                                bool force);

}  // namespace ropewalk
