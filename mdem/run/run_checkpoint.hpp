// The checkpoint of a run, for `resume`: the state of the simulation, of the files and of the counters around it,
// and what the run is made of.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "io/growing_file.hpp"
#include "io/limits_file.hpp"
#include "run/limit_watch.hpp"
#include "run/run_directory.hpp"
#include "sim/dynamics/step_control.hpp"
#include "run/stop_reason.hpp"

namespace ropewalk {

// The inputs that the motion of a run follows from.
struct RunOrigin {
  std::string scene;               // the text
  std::vector<std::string> sets;   // hashes of the parameter sets
  std::vector<std::string> files;  // hashes of the files that drives were read from
  std::string state;               // hash of the start, of a scene that reads its state from a file
  std::string version, git_id;     // version of the program
  std::string instructions;        // see instructions_in_use()
  std::string device;              // as --device names it; empty: none
  std::string own_forces;          // see own_forces_in_words()
};
// The origin of a run in this directory by this program, without a device.
RunOrigin origin_of(const RunDirectory& dir, const Scene& scene);

// How far files had come. No bytes of events: there was no file.
struct FileMarks {
  FileMark log, frames, events;
};

struct RunCheckpoint {
  FileMarks files;          // they are cut back to these
  double first_energy = 0;  // eV, total at the start: origin of the balance
  EnergyMark energy;        // energies of the state
  double wall_seconds = 0;
  StepControl control;
  OnLimit on_limit = OnLimit::warn;
  StopReason ends_for = StopReason::none;  // the run takes no further step, for a limit that was passed here
  LimitsFile limits;
  std::string simulation;
  std::shared_ptr<const RunCheckpoint> snapshot;  // the last state to go back to; null: this one
  RunOrigin origin;                               // not of a snapshot
};

// The one that was there before is kept as checkpoint-before.bin.
void write_checkpoint(const RunDirectory& dir, const RunCheckpoint& checkpoint);

// Throws InputError where there is none of this version; one that is there may be damaged.
void refuse_without_checkpoint(const RunDirectory& dir);

// The newest that is whole. Throws InputError where there is none.
RunCheckpoint read_checkpoint(const RunDirectory& dir);

// The place where a run can go on: the newest checkpoint that is whole and whose log, frames and events are there.
// Frames and events that are missing or damaged are done without. `remarks`: the faults found, a sentence each. Throws InputError
// where there is no whole checkpoint, or none whose log is there.
struct ResumePoint {
  std::string path;
  RunCheckpoint checkpoint;
  std::vector<std::string> remarks;
};
ResumePoint find_resume_point(const RunDirectory& dir);

// The simulation of a scene where the checkpoint has it. Throws InputError where it is of another scene.
Simulation simulation_at(const RunDirectory& dir, const Scene& scene, const Prepared& prepared,
                         const RunCheckpoint& checkpoint);

}  // namespace ropewalk
