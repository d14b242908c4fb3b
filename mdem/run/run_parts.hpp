// The parts of a run, on which its loops work.
#pragma once

#include <string>

#include "run/rollback.hpp"
#include "run/run_settings.hpp"

namespace ropewalk {

struct RunParts {
  RunParts(RunDirectory dir, Scene scene, const RunSettings& asked, RunListener& follower);
  RunParts(const RunParts&) = delete;
  RunParts& operator=(const RunParts&) = delete;

  const State& state() const { return moving.state(); }
  std::int64_t step() const { return moving.simulation.step_count(); }
  // Moves the scene on the device that the settings name. Throws InputError where it cannot.
  void use_device();
  void write_row();
  void tell_first_break(const LogRow& before);
  void write_frame() { files.write_frame(moving); }
  // Where the run stops for this reason: a checkpoint as of a run that goes on. What is written later is taken back
  // by `resume`.
  void keep_for(StopReason why);
  // The same, and then the row and the frame of the last step. Returns `why`, or StopReason::limit where this step
  // passes one.
  StopReason stop(StopReason why);
  // Row and frame of this step, where they are not there yet.
  void write_last();
  // Asks the listener and the clock whether the run has to stop now. Returns the reason, or StopReason::none.
  StopReason asked_to_stop();

  RunSettings settings;
  RunListener& listener;
  RunClock clock;
  MovingScene moving;
  RunSchedule schedule;
  StopWatch stops;
  RunFiles files;
  LimitGuard limits;
  Checkpoints checkpoints;
  Rollback rollback;

  LogRow last_row;
  StopReason at_once = StopReason::none;  // before the first step
  bool took_all_steps = false;            // a relaxation had run out of its steps when it was resumed
  bool told_break = false;                // the first break of a tube is reported
  std::string asked_by;                   // who asked for an end
  std::string reason;                     // of the end, in words
  std::string remedy;                     // where a relaxation does not come to rest; empty: resume it
  bool at_rest = true;                    // false: a relaxation ran out of steps
};

}  // namespace ropewalk
