// The processor time that a run will take, from short stretches of it.
#pragma once

#include <string>

namespace ropewalk {

struct RunTime {
  double elements = 0;
  double steps = 0;    // of a relaxation that was not at rest soon: 0
  double each = 0;     // s, of a step; mean over the run
  double outputs = 0;  // s: start-up, log, frames, checkpoint, report
  bool relaxes = false;
  double total() const { return steps * each + outputs; }
};

// By one thread: threads that wait for one another spend processor time as well.
//
// Steps are timed in the scene itself. A rope that is to be twisted is laid twisted first, half-way and moving for
// the ramp, all of the way for the hold: tubes that cross have more nodes in reach, and what moves needs new lists.
// All else is timed in a short run in a process of its own with as many rows and frames as time allows; of those
// that it leaves out one is timed. A relaxation is begun; its steps are known if it comes to rest.
//
// `text`: of a scene, as a file at `path` would have it; a temporary file stands there for a moment.
RunTime time_run(const std::string& text, const std::string& path);

}  // namespace ropewalk
