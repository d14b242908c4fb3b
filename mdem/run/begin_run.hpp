// How a run is begun, or goes on in its directory.
#pragma once

#include <memory>

#include "run/run.hpp"

namespace ropewalk {

// Makes the directory with the scene and the state at time zero as its checkpoint. Everything that can be wrong is
// found before a file is touched. Throws InputError. The listener must live as long as the run.
std::unique_ptr<Run> begin_run(const Scene& scene, const RunDirectory& dir, const RunSettings& settings,
                               RunListener& listener);

// Goes on from the newest checkpoint that can be used, with the instruction set that the run was begun with unless
// another one is asked for. Throws InputError where there is no checkpoint, where scene, sets or program are others
// and that is not accepted, and where the end does not lie ahead.
std::unique_ptr<Run> resume_run(const RunDirectory& dir, const ResumeSettings& settings, RunListener& listener);

}  // namespace ropewalk
