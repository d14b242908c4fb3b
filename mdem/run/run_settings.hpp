// Settings of a run besides its scene.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "run/limit_watch.hpp"
#include "run/own_forces.hpp"
#include "run/wall_time.hpp"

namespace ropewalk {

struct RunSettings {
  std::int64_t steps = -1;  // time step at which it stops; -1: the scene's end
  double until_ps = -1;     // time at which it stops; -1: the scene's end
  OnLimit on_limit = OnLimit::warn;
  bool may_refine = true;  // false: of a run in a campaign, whose verbs take no OnLimit::refine
  WallTime wall_time;
  bool force = false;  // replace an earlier run
  std::vector<OwnForceOfRun> own_forces = {};
  // As open_device() names it; empty: this processor alone (resume: what the run was begun with); "none": this
  // processor alone.
  std::string device;
};

struct ResumeSettings : RunSettings {
  std::string instructions;     // empty: those that the run was begun with
  bool accept_changes = false;  // of scene, sets or program
};

}  // namespace ropewalk
