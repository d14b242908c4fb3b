// The parts of a run, on which its loops work.
#pragma once

#include <string>

#include "run/run_settings.hpp"
#include "run/way_back.hpp"

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
  void write_frame() { files.write_frame(moving); }
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
  WayBack way_back;

  LogRow last_row;
  std::int64_t first_step = -1;           // its row and frame were there when the run began or went on
  StopReason at_once = StopReason::none;  // before the first step
  std::string asked_by;                   // who asked for an end
  std::string reason;                     // of the end, in words
  bool at_rest = true;                    // false: a relaxation ran out of steps
};

}  // namespace ropewalk
