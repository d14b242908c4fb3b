// The step that follows the motion. A run marks a good state every `window` steps. Where the motion blows up, or
// the account of energy does not close over a window, it goes back to the last mark and divides every step in two,
// up to `most` parts, and puts steps together again once the motion has been quiet. Files count by the whole steps.
// The simulator (run/rollback.hpp) and the ranks of LAMMPS (lammps/fix_nve.hpp) decide by this rule.
//
// With a device it looks and marks less often (RunSchedule::look_rarely) as long as steps are whole. Where a long
// window fails, it does that window again and looks closely, so that it divides the same steps as without a device.
//
// All of it depends on the states alone: a run is the same bits on any number of threads and after a resume.
#pragma once

#include <cstdint>

#include "sim/dynamics/energy_mark.hpp"
#include "sim/dynamics/shorter_steps.hpp"

namespace ropewalk {

struct StepControl {
  static constexpr std::int64_t window = account_window, least_keep = 512, most_keep = 8192;  // steps
  static constexpr int most = most_parts_of_a_step;

  std::int64_t kept_until = 0;     // the step before which steps stay divided
  std::int64_t keep = least_keep;  // for how many they are divided when it happens next
  std::int64_t close_until = 0;    // the step before which a run with a device looks closely

  // Both return into how many parts a step is divided from now on; `divided`: so far.
  // After a failure, with the motion back at the mark of this step.
  int shorten(int divided, std::int64_t step);
  // At a mark, after a window without failure.
  int lengthen(int divided, std::int64_t step);
  // Whether the next window is a short one.
  bool looks_closely(int divided, std::int64_t step) const;
};

}  // namespace ropewalk
