// An estimate of the processor time of a run, from short parts of it.
#pragma once

#include <string>

namespace ropewalk {

struct RunTime {
  double elements = 0;
  double steps = 0;     // 0 for a relaxation that did not come to rest during the timing
  double each = 0;      // s per step, mean over the run
  double at_start = 0;  // cost of the first steps, s per step
  double outputs = 0;   // s: start-up, log, frames, checkpoint, report
  bool relaxes = false;
  double total() const { return steps * each + outputs; }
};

// Timings use one thread, since threads that wait for one another spend processor time as well.
//
// Steps are timed in the scene itself. A rope under [twist] or rotation is first put into twisted states, since
// crossing tubes have more nodes in reach and motion needs new lists: half the twist and in motion for the ramp,
// the full twist for the hold. Start-up and outputs are timed in a short run in another process. It writes as many
// rows and frames as time allows; the time of the others is that of a single one. A relaxation is begun; its number
// of steps is known if it comes to rest.
//
// `text` is a scene as in a file at `path`. Throws InputError for a scene that cannot be run.
RunTime time_run(const std::string& text, const std::string& path);

}  // namespace ropewalk
