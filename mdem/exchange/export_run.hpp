// Runs go to LAMMPS. An exported directory is a run directory like any other, with the files of
// scene/lammps_files.hpp beside those of a run.
#pragma once

#include "run/run_checkpoint.hpp"
#include "run/run_listener.hpp"

namespace ropewalk {

// Makes the directory for a scene at time zero. Throws InputError for a scene that LAMMPS cannot run. `force`
// replaces an earlier run there.
void export_scene(const Scene& scene, const RunDirectory& to, bool force, RunListener& listener);

// Makes the directory for a run where it stands.
void export_run(const RunDirectory& from, const RunDirectory& to, bool force, RunListener& listener);

// The checkpoint of a run of this scene. Throws InputError for a run of another scene.
RunCheckpoint checkpoint_to_export(const RunDirectory& dir, const Scene& scene, RunListener& listener);

}  // namespace ropewalk
